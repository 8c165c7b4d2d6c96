/* The edge map as a full-screen pass. */
void main()
{
    detect_edges();
}
