// A picture of a model, and what is seen in its middle: embed_pick MODEL OUT.png
#include <cmath>
#include <iostream>
#include <limner/limner.hpp>

int main(int count, char **arguments)
try {
    if (count != 3)
        return 1;
    const limner::scene scene(arguments[1]);
    limner::look        look("edges");
    limner::renderer    renderer;
    lmn_draw_desc       desc = limner::draw_desc(320, 240);
    look.set("lines.width", "2px");
    desc.maps = true; // for all that follows but the picture
    const limner::drawing drawing(renderer, scene, look, desc);
    drawing.write(arguments[2]);

    const std::vector<float> depth = drawing.map(LMN_MAP_DEPTH);
    float                    nearest = INFINITY;
    for (float d : depth)
        nearest = std::fmin(nearest, d);
    std::cout << "nearest " << nearest << "\n";

    const lmn_pick seen = drawing.pick(160, 120);
    if (seen.part) {
        std::cout << "part " << scene.part(seen.part - 1)->name << "\n";
        const auto back = drawing.project({seen.position[0], seen.position[1], seen.position[2]});
        std::cout << "pixel " << std::floor(back->x) << " " << std::floor(back->y) << "\n";
    }
    std::cout << "parts " << drawing.pick_parts(0, 0, 320, 240).size() << "\n";
    return 0;
} catch (const limner::error &e) {
    std::cerr << e.what() << "\n" << e.hint() << "\n";
    return 1;
}
