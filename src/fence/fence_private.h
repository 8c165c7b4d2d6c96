/* What the files of the fence share. */
#ifndef LIMNER_FENCE_FENCE_PRIVATE_H
#define LIMNER_FENCE_FENCE_PRIVATE_H

#include "fence/fence.h"

/* The address sanitizer maps terabytes, so that there the child's address space cannot be limited; its resident
 * memory can. */
#if defined(__SANITIZE_ADDRESS__)
#define FENCE_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FENCE_SANITIZED
#endif
#endif

enum { FENCE_CHANNEL = 3 };

/* In the child: gives up all but the channel, which becomes descriptor FENCE_CHANNEL. `address_space` 0: not
 * limited. `prepare`, which may be NULL, runs when everything is closed and nothing is forbidden yet; what it has
 * opened can be read later on. */
bool fence_lock(int channel, size_t address_space, fence_prepare prepare);

#endif
