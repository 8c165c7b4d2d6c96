/* Window depth from eye depth and back. */
float eye_depth_at(float window)
{
    float ndc = 2.0 * window - 1.0;
    return u_perspective > 0.5 ? u_window_depth.y / (ndc + u_window_depth.x) : (u_window_depth.y - ndc) / u_window_depth.x;
}

float window_depth_of(float eye)
{
    float clip = u_window_depth.y - u_window_depth.x * eye;
    return 0.5 * (u_perspective > 0.5 ? clip / eye : clip) + 0.5;
}
