/* Lengths on paper: how large a picture is when it is printed, and how many of its pixels a length takes. */
#ifndef LIMNER_BASE_PAPER_H
#define LIMNER_BASE_PAPER_H

#define MM_PER_INCH     25.4
#define POINTS_PER_INCH 72.0
/* What look files of version 1 and the suffix "px" mean, as in CSS. */
#define PX_PER_INCH  96.0
#define MM_PER_POINT (MM_PER_INCH / POINTS_PER_INCH)

/* The longer side of pictures that say no resolution: 1024 pixels of 1/96 inch. */
#define PAPER_SIDE_MM (1024 * MM_PER_INCH / PX_PER_INCH)

/* Pixels of a picture to a millimetre of paper. `dpi`: pixels an inch; 0: so many that the longer side is as long as
 * that of any picture, whatever its size. */
static inline double paper_pixels_per_mm(int width, int height, double dpi)
{
    return dpi > 0 ? dpi / MM_PER_INCH : (width > height ? width : height) / PAPER_SIDE_MM;
}

/* Samples along each side of a pixel where nothing is said: small pictures are drawn as finely as those of usual size
 * and reduced, since marks thinner than a pixel are no marks. */
static inline int paper_samples_side(int width, int height, double dpi)
{
    enum { MOST = 8, PIXELS_MOST = 2048 };
    int    longer = width > height ? width : height, side = 1;
    double finer = PX_PER_INCH / MM_PER_INCH / paper_pixels_per_mm(width, height, dpi);
    while (side < MOST && side + 0.5 <= finer && (side + 1) * longer <= PIXELS_MOST)
        side++;
    return side;
}

#endif
