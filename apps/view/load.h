/* Reading models away from the interface. */
#ifndef LIMNER_VIEW_LOAD_H
#define LIMNER_VIEW_LOAD_H

#include <gio/gio.h>

#include "document.h"

/* How far it is, 0 … 1. On the main thread. */
typedef void (*load_progress)(double fraction, void *user);

/* Reads files into one scene; ends with load_finish in `done`, also when it is cancelled. */
void load_begin(const char *const *paths, GCancellable *cancel, load_progress progress, GAsyncReadyCallback done,
                void *user);

/* The scene, or NULL with what went wrong (LMN_CANCELLED: somebody cancelled). The caller drops the reference. */
scene_ref *load_finish(GAsyncResult *result, lmn_error *error);

#endif
