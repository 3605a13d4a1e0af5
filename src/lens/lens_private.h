/* Shared by the files of the room: the prescription at one wavelength, its first order, real rays and the beam of one
 * field. Pure, unless a function takes a bench: that borrows its model, and serves one thread. */
#pragma once

#include "base/array.h"
#include "geometry/primitives/asphere.h"
#include "lens/lens.h"
#include "render/inspect/probe.h"

/* --- place.c --- */

/* A surface at one wavelength; indices as lens_index_after has them. */
typedef struct lens_step {
    double c, k, z;           /* curvature, conic constant, vertex; mm */
    double c0;                /* curvature at the vertex along Y: of the conic and the coefficient of r^2 */
    even_asphere shape;       /* the same with all coefficients */
    double n, n_after, clear; /* clear radius; INFINITY: none */
    bool mirror, silent;      /* silent: it neither bends nor reflects */
    bool folds;               /* a flat mirror that is tilted: its normal, and the rotation to the axis after it */
    vec3 normal;
    mat3 turn;
} lens_step;

typedef struct lens_model {
    lens_step step[LENS_SURFACES_MAX];
    int count, stop;
    double lambda_nm, n_object, n_image;
    double object_distance, z_image, image_c; /* INFINITY for a far object; curvature of the image's surface */
    double unit_mm;
} lens_model;

/* Sag at a radius, along Y, and its first two derivatives by the radius; NaN beyond the surface's end. */
double lens_sag(const lens_step *s, double rho, double *slope, double *bend);
/* The second derivative across that meridian. */
double lens_bend_across(const lens_step *s, double rho);
/* Sag at any point, and its derivatives. */
double lens_height(const lens_step *s, double x, double y, double *by_x, double *by_y);

status lens_model_make(const lens_prescription *p, double lambda_nm, lens_model *out, diagnostic *why);

/* Gaussian constants; positions from the first vertex (z_...), mm. */
typedef struct lens_first {
    double power, bfl, ffl, z_front, z_rear, z_principal, z_principal_rear, z_nodal, z_nodal_rear;
    double z_entrance, entrance_d, z_exit, exit_d, stop_radius, per_height; /* per_height: of the stop, by the pupil */
    double stop_real; /* the stop's radius for real rays: lens_stop_radius */
    double f_number, working_number, z_focus, magnification, invariant, slope_max;
    lens_trail marginal, chief;
} lens_first;

status lens_first_make(const lens_prescription *p, const lens_model *m, lens_first *out, diagnostic *why);

/* --- rays.c --- */

typedef struct lens_bench {
    const lens_model *m;
    const lens_place *at;
    probe *p;
    ray_tree tree;
    double around; /* index of the surroundings, to which those of the paths are relative */
    double R[LENS_SURFACES_MAX], T[LENS_SURFACES_MAX]; /* of each surface and its coating for the ray traced last */
} lens_bench;

status lens_bench_open(const lens_model *m, const lens_place *at, isa level, lens_bench *out, diagnostic *why);
void lens_bench_close(lens_bench *b);

/* Why a ray does not arrive: nothing, it left the sequence of surfaces (a rim, a mount, total reflection), or it never
 * reached the stop. */
typedef enum lens_loss { LENS_PASSES, LENS_LOST, LENS_LOST_EARLY } lens_loss;

typedef struct lens_ray {
    vec3 start, launched;              /* where and in which direction it began */
    vec3 hit[LENS_SURFACES_MAX];       /* on a fold mirror: on the plane across the axis that it unfolds to */
    vec3 along[LENS_SURFACES_MAX + 1]; /* before surface i; the last is that at the image */
    vec3 image, direction;             /* on the image's surface; unit vector */
    double path, stop_x, stop_y;       /* optical path from the start to the image's surface */
    double surfaces, media;            /* parts of unpolarised light that they pass on */
    lens_loss loss;
    int lost_at;
} lens_ray;

status lens_ray_trace(lens_bench *b, vec3 from, vec3 along, lens_ray *out, diagnostic *why);

/* Reflectances of the surfaces for light that comes back along the axis from the image, without mirrors: those of
 * absorbing coatings have two values. */
status lens_reflectances_back(lens_bench *b, double R[LENS_SURFACES_MAX], diagnostic *why);

/* --- aim.c --- */

/* The rays of one field at one wavelength. Launch coordinates (X, Y) are mm in a plane through `centre`, at right
 * angles to `along`. */
typedef struct lens_beam {
    lens_bench *b;
    bool far;
    vec3 object, centre, along, across, up;
    double back, stop_radius;
    double launch[2]; /* of the chief ray */
    double t[2];      /* the field's own direction across the axis: tangential; Y on the axis */
    /* Derivatives by the launch, row by row: of the stop's coordinates, and of the cosines of direction at the image
     * along the field's direction and at right angles to it. The latter are 0 where an obstruction hides them. */
    double per[4], cosines_per[4];
    double base[2], base_cosines[2]; /* of the ray at which they were taken: its launch, its cosines */
    lens_ray chief;
    bool blocked; /* the chief ray does not arrive; `chief` is then the mean of rays that do */
    /* The part of the stop that vignetting factors leave: the ellipse about (part_x, part_y), mm, with half axes in
     * units of the stop's radius. */
    double part_x, part_y, half_x, half_y;
} lens_beam;

/* A point of the stop in the frame in which the part that vignetting factors leave is a circle of the stop's radius. */
static inline double lens_beam_x(const lens_beam *b, double stop_x)
{
    return (stop_x - b->part_x) / b->half_x;
}
static inline double lens_beam_y(const lens_beam *b, double stop_y)
{
    return (stop_y - b->part_y) / b->half_y;
}

/* x and y: a field, in the prescription's own unit. */
status lens_beam_aim(lens_bench *b, const lens_prescription *p, const lens_first *first, double x, double y,
                     lens_beam *out, diagnostic *why);

/* The launches of the last rays of a row of evenly spaced targets, and what continues them: a parabola through three, a
 * line through two. A ray that did not arrive ends the row. */
typedef struct lens_row_launch {
    double last[3][2];
    int count;
} lens_row_launch;
/* False, and nothing changed: there are fewer than two. */
bool lens_row_guess(const lens_row_launch *row, double launch[2]);
void lens_row_add(lens_row_launch *row, bool arrives, const double launch[2]);

/* The ray through a point of the stop, in units of its radius. `launch`: where the search begins and what it found;
 * NULL begins at the chief ray. */
status lens_beam_ray(lens_beam *bundle, double px, double py, double launch[2], lens_ray *out, diagnostic *why);

/* The ray whose direction at the image has the cosines `target` along and across the field's direction, from a first
 * guess of its launch, which is replaced by what was found. */
status lens_beam_cosines(lens_beam *bundle, const double target[2], double tolerance, double launch[2], lens_ray *out,
                         diagnostic *why);

/* Waves by which the ray's wavefront is ahead of the sphere about the chief ray's image whose radius reaches to the
 * exit pupil; NaN for a ray that does not arrive. */
double lens_opd(const lens_beam *bundle, const lens_first *first, const lens_ray *r);

/* The radius of the stop for the stated aperture: by a real ray on the axis. */
status lens_stop_radius(lens_bench *b, const lens_prescription *p, lens_first *first, diagnostic *why);

/* --- what the sections compute --- */

typedef struct lens_study {
    const lens_prescription *p;
    const lens_options *options;
    lens_report *out;
    const lens_model *model; /* one for each wavelength */
    lens_bench *bench;
    lens_first first; /* at the primary wavelength */
    size_t waves, primary;
    double frequency_most;
    double solid_angle,
        transmitted; /* of a field that was computed, at the primary wavelength: lens_waves, lens_images */
} lens_study;

static inline void lens_row_put(lens_report *r, lens_row row)
{
    if (r->failed || !GROW(r->row, r->room, r->count + 1)) {
        r->failed = true;
        return;
    }
    r->row[r->count++] = row;
}

void lens_seidel(lens_study *s);
status lens_ghosts(lens_study *s, diagnostic *why);
status lens_images(lens_study *s, size_t field, diagnostic *why);
status lens_curves(lens_study *s, diagnostic *why);
status lens_waves(lens_study *s, size_t field, diagnostic *why);

/* --- pupil.c --- */

/* Rays that sample the cosines of direction at the image: n x n, row by row, rows along the field's direction. Optical
 * path difference in waves; place in the stop in units of its radius. Beyond what arrives they go on smoothly for some
 * samples, then they are NaN. */
enum { LENS_WAVES, LENS_STOP_X, LENS_STOP_Y, LENS_SAMPLE_KINDS };
typedef struct lens_samples {
    int n, count; /* count: of those that arrive */
    double step;  /* of the cosines */
    double stop_radius;
    double part_x, part_y, half_x, half_y; /* as in lens_beam, all in units of the stop's radius */
    double *value[LENS_SAMPLE_KINDS];
    bool *passes;
} lens_samples;

/* Released by lens_samples_release, also after an error. */
status lens_samples_make(int n, lens_samples *out, diagnostic *why);
void lens_samples_release(lens_samples *s);
/* any: whether there is light, and derivatives that find it. */
status lens_samples_trace(const lens_study *s, lens_beam *bundle, lens_samples *out, bool *any, diagnostic *why);

/* A finer grid of the same pupil: `cover` is the part of the cell that passes, area their sum. */
typedef struct lens_pupil {
    int n;
    double step, area;
    double *cover, *waves; /* one block */
} lens_pupil;

/* Of every skip-th sample, with `finer` points for each. Released by lens_pupil_release, also after an error. */
status lens_pupil_make(const lens_samples *s, int skip, int finer, lens_pupil *out, diagnostic *why);
void lens_pupil_release(lens_pupil *p);
