/* What ffmpeg is told of each format: its arguments between those of the frames and the name of the file, up to a
 * NULL. */
#ifndef LIMNER_FILM_ENCODER_H
#define LIMNER_FILM_ENCODER_H

#include "film/film.h"

const char *const *encoder_of_mp4(const film *f);
const char *const *encoder_of_webm(const film *f);
const char *const *encoder_of_gif(const film *f);

#endif
