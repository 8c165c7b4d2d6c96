// A partial product of a sphere and a box from which cylinders are subtracted: the widget of many books about solids.
$fn = 96;

module bore(length) {
    cylinder(h = length, r = 11.5, center = true);
}

difference() {
    intersection() {
        color("#d9a441") sphere(r = 30);
        color("#5b7fa6") cube(46, center = true);
    }
    color("#a63d40") {
        bore(70);
        rotate([90, 0, 0]) bore(70);
        rotate([0, 90, 0]) bore(70);
    }
}
