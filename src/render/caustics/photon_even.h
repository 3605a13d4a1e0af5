/* Is light even around a photon? The test by which discs become wider, photon_radius.c. */
#pragma once

#include "render/caustics/photon_map.h"

/* Sums over the photons of each box of the tree. photon_sums_make: NULL when out of memory or cancelled;
 * photon_sums_free releases. */
typedef struct photon_sums photon_sums;
photon_sums *photon_sums_make(const photon_map *m);
void photon_sums_free(photon_sums *s);
size_t photon_sums_bytes(void); /* for each box */

/* Light within that distance of photon i, on the same surface, is even as far as its noise lets see. */
bool photon_sums_even(const photon_sums *s, const photon_map *m, size_t i, double radius);
