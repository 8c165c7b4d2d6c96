/* Texts for people, in their language. */
#ifndef LIMNER_VIEW_WORDS_H
#define LIMNER_VIEW_WORDS_H

#include <glib/gi18n.h> /* _("text"), N_("text") for tables */

#endif
