/* Depth focus: the fraction of its ink that a position keeps. Müller, section 5 (figures 16 and 21), which has no formula; row P22. */
uniform vec4 u_focus; /* share that is lost at most, depth that is looked at, 1 / range, 0; eye depths */

float in_focus(float eye_depth)
{
    float off = clamp(abs(eye_depth - u_focus.y) * u_focus.z, 0.0, 1.0);
    return 1.0 - u_focus.x * off * off * (3.0 - 2.0 * off);
}

/* The same for a value of a depth buffer. */
float in_focus_of_window(float depth)
{
    return in_focus(eye_depth_at_window(depth));
}
