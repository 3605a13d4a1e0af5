/* Errors inserted into a copy of the sources by experiments/detect.sh, where this is base/injected.h; detect.tsv says at
 * which places. Sizes; all zero at first. */
#pragma once

enum injected_error {
    INJECT_INDEX,  /* the denser medium's index at an interface, relative: directions and reflectances */
    INJECT_TURN,   /* the ratio of indices in refracted directions, relative */
    INJECT_SHARES, /* the index behind the surface in reflectances, relative */
    INJECT_SIDE,   /* the same replaced by the surroundings' index, as a share of the difference */
    INJECT_SWAP,   /* reflectances of s and p exchanged, as a share of the difference */
    INJECT_TOTAL,  /* of totally reflected light, the share that is lost */
    INJECT_TILT,   /* normal turned in the plane of incidence, rad */
    INJECT_KINDS
};
extern double injected[INJECT_KINDS];
