/* Windows and doors of a wall, without a picture of them. Nienhaus 2005, section 4.8: facade elements composed for each building from sets of texture
 * coordinates, which tell storeys, use and occupancy; row C07. Bays and storeys divide a wall evenly, so none is cut off at its ends. */
#include "light/point.glsl"
#include "gpu/hash.glsl"

/* Storeys, 0 where nobody says; use (src/plan/building.h). */
#ifdef HAS_FACTS
#define u_building ivec2(v_own.yz)
#else
uniform ivec2 u_building;
#endif

const int FACADE_AUTO = 1, FACADE_OFFICE = 3, FACADE_INDUSTRIAL = 4;
const int USE_UNKNOWN = 0;
const int GROUND_STOREY_SHOPS = 1, GROUND_STOREY_BLANK = 2;

/* Buildings whose use nobody knows are dwellings, as most are. */
int facade_style()
{
    return u_facade != FACADE_AUTO ? u_facade : u_building.y == USE_UNKNOWN ? FACADE_AUTO + 1 : FACADE_AUTO + u_building.y;
}

/* An opening in its cell: left, low, right, high, fractions of the cell. Nothing: right before left. */
vec4 window_of(ivec2 cell, ivec2 cells, uint wall)
{
    const vec4 NOTHING = vec4(1.0, 1.0, 0.0, 0.0);
    bool ground = cell.y == 0;
    if (cell.y < 0 || cell.x < 0 || any(greaterThanEqual(cell, cells)))
        return NOTHING;
    if (ground && u_ground_storey == GROUND_STOREY_BLANK)
        return NOTHING;
    if (ground && u_ground_storey == GROUND_STOREY_SHOPS)
        return vec4(0.1, 0.06, 0.9, 0.78);
    if (facade_style() == FACADE_OFFICE)
        return vec4(0.03, 0.3, 0.97, 0.86);
    if (facade_style() == FACADE_INDUSTRIAL)
        return vec4(0.12, 0.52, 0.88, 0.86);
    if (ground && cell.x == int(wall % uint(cells.x)))
        return vec4(0.31, 0.0, 0.69, 0.76);
    return vec4(0.28, 0.3, 0.72, 0.84);
}

/* Fraction of a pixel of this size around a place that a rectangle covers. */
float covered(vec4 rectangle, vec2 at, vec2 pixel)
{
    vec2 low = max(rectangle.xy, at - 0.5 * pixel), high = min(rectangle.zw, at + 0.5 * pixel);
    vec2 share = clamp((high - low) / pixel, 0.0, 1.0);
    return share.x * share.y;
}

/* How much of a pixel bars cover that part a rectangle into so many columns and rows. Panes smaller than this have none. */
float bars_at(vec4 opening, vec2 panes, vec2 at, vec2 pixel)
{
    const float LEAST = 6.0, ALL = 10.0; /* pixels */
    vec2 size = (opening.zw - opening.xy) / panes, place = (at - opening.xy) / size, off = abs(place - round(place)) * size / pixel;
    vec2 sides = size / pixel;
    bvec2 between = lessThan(abs(round(place) - 0.5 * panes), 0.5 * panes - 0.5);
    vec2 cover = clamp(0.5 * u_bars + 0.5 - off, 0.0, 1.0) * vec2(between) * min(vec2(u_bars), 1.0);
    return max(cover.x, cover.y) * clamp((min(sides.x, sides.y) - LEAST) / (ALL - LEAST), 0.0, 1.0);
}

/* Columns and rows of panes. Doors have none. */
vec2 panes_of(vec4 opening, bool ground)
{
    int style = facade_style();
    return opening.y == 0.0 ? vec2(1.0) : ground && u_ground_storey == GROUND_STOREY_SHOPS ? vec2(3.0, 1.0) : style == FACADE_OFFICE ? vec2(4.0, 1.0)
         : style == FACADE_INDUSTRIAL ? vec2(5.0, 3.0) : vec2(2.0, 2.0);
}

/* Width of a frame, of the shorter side of its window. */
const float FRAME_MOST = 0.1;

/* What facades make of a wall: the shares of frames, of dark glass and of lit glass; the wall itself is the rest. Here of what is open near at hand, one by one. `cells`:
 * bays and storeys. */
vec3 windows_near(vec2 cells, vec2 pixel)
{
    vec2 along = v_wall.xy * cells;
    vec2 cell = floor(along), at = along - cell;
    /* One number a wall: what interpolation leaves of its last bits is rounded off. */
    uint wall = hash_of(uvec3(round(64.0 * v_wall.zw), 0.0), 0u);
    uint window = hash_of(uvec3(ivec3(cell, 1)), wall);
    vec4 opening = window_of(ivec2(cell), ivec2(cells), wall);
    /* Of small windows frames are finer, lest they grow into each other. */
    vec2 sides = (opening.zw - opening.xy) / pixel;
    float frame_width = min(u_frame, FRAME_MOST * min(sides.x, sides.y));
    vec4 around = opening + vec4(-1.0, -1.0, 1.0, 1.0) * (frame_width * pixel.xyxy);
    bool there = opening.z > opening.x;
    float glass = there ? covered(opening, at, pixel) : 0.0;
    float frame = there && u_frame > 0.0 ? clamp(covered(around, at, pixel) - glass, 0.0, 1.0) : 0.0;
    float occupied = float(window >> 8) / 16777216.0 < u_occupancy ? 1.0 : 0.0, bars = 0.0;
    int parted = u_bars > 0.0 && glass > 0.0 ? 1 : 0;
    for (int once = 0; once < parted; once++)
        bars = bars_at(opening, panes_of(opening, cell.y == 0.0), at, pixel);
    float panes = glass * (1.0 - bars);
    return vec3(frame * (1.0 - glass) + glass * bars, panes * (1.0 - occupied), panes * occupied);
}

/* Too small to be seen one by one, windows are the mean of what they are. */
vec3 windows_far(vec2 cells)
{
    vec2 along = v_wall.xy * cells, cell = floor(along);
    vec4 own = window_of(ivec2(cell), ivec2(cells), 1u);
    vec4 mean_of = window_of(ivec2(0, 1), ivec2(1, 2), 1u);
    float area = own.z > own.x ? max(mean_of.z - mean_of.x, 0.0) * max(mean_of.w - mean_of.y, 0.0) : 0.0;
    return vec3(0.0, area * (1.0 - u_occupancy), area * u_occupancy);
}

vec4 surface_detail()
{
    float storeys = v_wall.z <= 0.0 ? 0.0 : u_building.x > 0 ? float(u_building.x) : round(v_wall.w / u_storey);
    float bay = facade_style() == FACADE_INDUSTRIAL ? 2.0 * u_bay : u_bay;
    vec2 cells = vec2(v_wall.z > 0.6 * bay ? max(round(v_wall.z / bay), 1.0) : 0.0, storeys);
    vec2 pixel = max(fwidth(v_wall.xy) * cells, vec2(1e-6));
    float keeps = clamp((1.0 / max(pixel.x, pixel.y) - 3.0) / 4.0, 0.0, 1.0);
    /* Loops that run once or not at all: software drivers skip loops, not branches. Roofs have no windows, and of most walls of a town nothing is near, or nothing far. */
    vec3 near = vec3(0.0), far = vec3(0.0);
    int is_near = cells.x * cells.y > 0.0 && keeps > 0.0 ? 1 : 0, is_far = cells.x * cells.y > 0.0 && keeps < 1.0 ? 1 : 0;
    for (int once = 0; once < is_near; once++)
        near = windows_near(cells, pixel);
    for (int once = 0; once < is_far; once++)
        far = windows_far(cells);
    return vec4(mix(far, near, keeps), 0.0);
}
