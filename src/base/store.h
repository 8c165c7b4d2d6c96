/* A position on disk for textures that take long to make, by a hash of what they are made from. */
#ifndef LIMNER_BASE_STORE_H
#define LIMNER_BASE_STORE_H

#include "base/mip_chain.h"

/* FNV-1a. Each step can be undone, so that no single changed byte goes unnoticed. */
uint64_t store_hash(const void *bytes, size_t size);
/* The same of a file's content, so that what was made from it is found again for as long as it is the same; 0 when it
 * cannot be read. */
uint64_t store_hash_of_file(const char *path);

/* Reads what was kept under this description (any text, all that decides the content, with a version). False when
 * there is nothing, or when it is damaged, of another description with the same hash, or unreadable: then it is
 * made again. The folder is LIMNER_CACHE, else XDG_CACHE_HOME/limner, else HOME/.cache/limner; LIMNER_CACHE set and
 * empty, or none of them set: nothing is kept. */
bool store_find(mip_chain *out, const char *description);
/* Keeps it, whole or not at all; what cannot be written is left out silently, since it can be made again. At most
 * 256 MiB are kept, the oldest go first. */
void store_keep(const mip_chain *chain, const char *description);

#endif
