/* The window depth that all passes over an item with shared planes write. */
float window_depth()
{
    float depth = gl_FragCoord.z;
    int shared_plane = (v_key & 0xFFFFu) != 0u ? 1 : 0;
    for (int once = 0; once < shared_plane; once++)
        depth = clamp(window_depth_at(fragment_depth()), 0.0, 1.0);
    return depth;
}
