/* Two even numbers 0 … 1, independent of each other, as one that is even again: the fraction of them for which the weighted sum is less. */
float even_sum(vec2 parts, float second)
{
    float most = max(second, 1.0 - second), least = max(1.0 - most, 1e-4), x = mix(parts.x, parts.y, second), y = 1.0 - x;
    float ends = 0.5 / (least * most);
    return x < least ? x * x * ends : x > most ? 1.0 - y * y * ends : (x - 0.5 * least) / most;
}
