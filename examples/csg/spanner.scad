// A combination spanner for 14 mm nuts: an open jaw, a ring with twelve points, a handle with a recess on each face and a hole.
$fn = 96;

width   = 14;     // across the flats of the nut
between = 120;    // centre of the jaw to centre of the ring
tilt    = 15;     // of the jaw against the handle
steel   = [0.72, 0.75, 0.78];
cut     = [0.80, 0.45, 0.25];

// The outline of a nut, flats across y.
module nut(extra = 0) {
    rotate(30) circle(d = (width + extra) / cos(30), $fn = 6);
}

// Round, with blunt ends.
module jaw_outline() {
    rotate(tilt) intersection() {
        hull() {
            circle(r = 15);
            translate([-6, 0]) circle(r = 14);
        }
        translate([-16, -20]) square(40);
    }
}

// The opening runs out at the front.
module jaw_opening() {
    rotate(tilt) {
        linear_extrude(height = 30, center = true) nut(0.3);
        translate([-20, 0, 0]) cube([40, width + 0.3, 30], center = true);
    }
}

module ring_opening() {
    linear_extrude(height = 40, center = true) union() {
        nut(0.3);
        rotate(30) nut(0.3);
    }
}

module handle() {
    hull() {
        translate([8, 0, 0]) cylinder(h = 6, r = 6.5, center = true);
        translate([between - 8, 0, 0]) cylinder(h = 6, r = 5.5, center = true);
    }
}

// A long recess with round ends on one face.
module recess() {
    hull() {
        translate([30, 0, 0]) cylinder(h = 2, r1 = 3, r2 = 4, center = true);
        translate([between - 40, 0, 0]) cylinder(h = 2, r1 = 2.6, r2 = 3.6, center = true);
    }
}

difference() {
    color(steel) union() {
        linear_extrude(height = 7, center = true) jaw_outline();
        handle();
        // The ring is a barrel: a sphere's middle between two planes.
        translate([between, 0, 0]) intersection() {
            scale([1, 1, 1.4]) sphere(r = 13.5);
            cube([40, 40, 11], center = true);
        }
    }
    color(cut) {
        jaw_opening();
        translate([between, 0, 0]) ring_opening();
        translate([0, 0, 3]) recess();
        mirror([0, 0, 1]) translate([0, 0, 3]) recess();
        translate([between - 24, 0, 0]) cylinder(h = 20, r = 2.4, center = true);
    }
}
