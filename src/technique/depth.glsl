/* Window depth from eye depth and back, of the frame's projection. */
float window_depth_at_eye(float eye)
{
    return 0.5 * (u_window_depth.y - u_window_depth.x * eye) / (u_window_depth.w - u_window_depth.z * eye) + 0.5;
}

float eye_depth_at_window(float window)
{
    float ndc = 2.0 * window - 1.0;
    return (u_window_depth.y - u_window_depth.w * ndc) / (u_window_depth.x - u_window_depth.z * ndc);
}
