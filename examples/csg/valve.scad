// The body of a ball valve: a cast ball with two pipe flanges and a neck for the stem, ribs between them, and all that a lathe and a
// drill take away from it. What is machined has a colour of its own.
$fn = 96;

iron  = [0.50, 0.58, 0.64];
steel = [0.90, 0.70, 0.38];

length    = 160;   // from flange to flange
pipe      = 22;    // outer radius
bore      = 15;
flange    = 46;    // radius
thickness = 13;
neck      = 24;    // outer radius
height    = 64;    // of the neck's flange above the axis
ball      = 38;
foot      = 46;    // of the drain's face below the axis

module along_x() rotate([0, 90, 0]) children();
module both_ends() for (side = [0, 1]) mirror([side, 0, 0]) children();

// Half of the pipe, turned: a hub that runs out into the flange, and the raised face.
module end_casting() {
    along_x() rotate_extrude() polygon([[0, 0], [pipe, 0], [pipe, length / 2 - 34], [pipe + 5, length / 2 - thickness],
        [flange, length / 2 - thickness], [flange, length / 2 - 2], [32, length / 2 - 2], [32, length / 2], [0, length / 2]]);
}

module neck_casting() {
    rotate_extrude() polygon([[0, 0], [neck, 0], [neck, height - 18], [neck + 4, height - 11], [40, height - 11], [40, height], [0, height]]);
}

// A plate from the neck's flange down to the pipe's hub.
module rib() {
    rotate([90, 0, 0]) linear_extrude(height = 7, center = true)
        polygon([[neck - 6, 10], [length / 2 - thickness + 1, pipe - 2], [length / 2 - thickness + 1, pipe + 10], [neck + 11, height - 10],
            [neck - 6, height - 10]]);
}

module casting() {
    sphere(r = ball);
    both_ends() {
        end_casting();
        rib();
    }
    neck_casting();
    translate([0, 0, -foot]) cylinder(h = foot, r = 13);
}

// The same at places on a circle.
module on_circle(count, radius, turn) {
    for (i = [0 : count - 1])
        rotate(turn + i * 360 / count) translate([radius, 0, 0]) children();
}

module inside() {
    along_x() cylinder(h = length + 2, r = bore, center = true);
    // The chamber of the ball, and the pockets of its seats.
    intersection() {
        sphere(r = 31);
        cube([44, 80, 80], center = true);
    }
    along_x() cylinder(h = 54, r = 18, center = true);
    // The way of the stem, with two shoulders for its packing.
    cylinder(h = height + 1, r = 9);
    translate([0, 0, height - 26]) cylinder(h = 30, r = 14);
    translate([0, 0, height - 5]) cylinder(h = 10, r = 26);
    // The drain: drilled, with the point that a drill leaves.
    translate([0, 0, -foot - 1]) cylinder(h = 9, r = 7);
    translate([0, 0, -foot + 8]) cylinder(h = 3.5, r1 = 7, r2 = 0);
    translate([0, 0, -foot - 1]) cylinder(h = 22, r = 3);
}

module holes() {
    both_ends() along_x() on_circle(8, 39, 22.5) {
        translate([0, 0, length / 2 - thickness - 1]) cylinder(h = thickness + 2, r = 4, $fn = 48);
    }
    on_circle(6, 33, 30) {
        translate([0, 0, height - 12]) cylinder(h = 14, r = 3.2, $fn = 48);
    }
}

difference() {
    color(iron) casting();
    color(steel) {
        inside();
        holes();
    }
}
