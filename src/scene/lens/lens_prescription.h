/* The prescription of a lens system: its surfaces in the order in which light meets them, as an optical designer
 * writes them. Lens systems of scenes, files of prescriptions and reports all use this structure.
 *
 * Conventions, those of optical design: light travels along +y of the system's frame, from the first surface to the
 * last; a radius is above 0 if its centre is on the image's side of the vertex; a thickness is the distance along +y
 * to the next vertex, and is below 0 where the light travels back after a mirror. Lengths are in the unit of the
 * prescription, unit_mm millimetres.
 *
 * Ownership: lens_prescription_release frees surfaces and `kept`; names are within the structure. A law's optical data
 * are borrowed from the scene or held by the caller. Errors: STATUS_BAD_INPUT with file, line, column and remedy. */
#pragma once

#include "geometry/primitives/asphere.h"
#include "scene/model/medium.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* EVEN_TERMS: coefficients of r^4, r^6, ... r^20; ODD_TERMS: of r, r^2, r^3, r^5, ... r^15. */
enum {
    LENS_EVEN_TERMS = 9,
    LENS_ODD_TERMS = 9,
    LENS_SURFACES_MAX = 200,
    LENS_LIST_MAX = 24,
    LENS_NAME_MAX = 64,
    LENS_NOTE_MAX = 2048
};

typedef enum lens_medium_kind {
    LENS_AIR,       /* the surroundings */
    LENS_CATALOGUE, /* `name` is a medium of the catalogue (optics/media.h) */
    LENS_DATA,      /* `name` is an entry of the scene's data, or a glass of a catalogue file */
    LENS_MODEL,     /* n_d and V_d: a glass code, or a glass that is known by no more */
    LENS_CONSTANT   /* n_d at all wavelengths */
} lens_medium_kind;

typedef struct lens_medium {
    lens_medium_kind kind;
    char name[LENS_NAME_MAX]; /* as the file writes it; "" for none */
    int glass_file;           /* LENS_DATA: its file among lens_glasses; of a scene, its entry of the data; or -1 */
    double n_d, V_d;          /* for LENS_MODEL, and where a file states them; V_d is 0 for none */
    index_law law;            /* by which lens_medium_index computes the index; not for LENS_AIR. Of a glass in a
                                 catalogue file: its formula, the same as that of the scene's data */
    double around;            /* index of the surroundings if they are not air; 0: air */
} lens_medium;

typedef struct lens_surface {
    char name[LENS_NAME_MAX];     /* the file's comment; "" for none */
    double radius;                /* 0: flat */
    double conic;                 /* conic constant k; 0: sphere */
    double even[LENS_EVEN_TERMS]; /* sag = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + even[0] r^4 + even[1] r^6 + ... */
    double odd[LENS_ODD_TERMS];   /* + odd[0] r + odd[1] r^2 + odd[2] r^3 + odd[3] r^5 + ... */
    side_form form;               /* geometry/primitives/asphere.h; not round: the above holds along y, this along x: */
    double radius_x, conic_x;
    double thickness;   /* to the next surface; after the last surface, to the image */
    lens_medium medium; /* after the surface; for a mirror that before it */
    double diameter;    /* clear diameter; 0: not stated */
    double hole;        /* diameter of the hole in a mirror; 0: none */
    double chamfer;     /* length of the bevel at the edge of a side of glass in air (scene(5), chamfer_1); 0: none */
    /* Of a flat mirror that folds the axis: its normal is the axis, turned by tilt_y about Y and then by tilt_x about X
     * (Y to Z). What follows is given as if the mirror was not tilted, so that first-order data are those of the
     * unfolded system, along the folded axis. */
    double tilt_x_deg, tilt_y_deg;
    bool mirror; /* after which the light travels back: behind glass, through the same surfaces again */
    long line;   /* in the file; 0: none */
} lens_surface;

typedef enum lens_aperture_kind {
    LENS_APERTURE_STOP,   /* the diameter of the stop surface */
    LENS_APERTURE_PUPIL,  /* diameter of the entrance pupil */
    LENS_APERTURE_NUMBER, /* f-number in the image space, for an object at infinity: focal length / entrance pupil */
    LENS_APERTURE_OBJECT  /* numerical aperture in the object space */
} lens_aperture_kind;

typedef enum lens_field_kind {
    LENS_FIELD_ANGLE, /* degrees from the axis, in the object space */
    LENS_FIELD_OBJECT /* height of the object; its distance is finite */
} lens_field_kind;

/* x and y of the file's transverse frame; for ANGLE in degrees. */
typedef struct lens_field {
    double x, y, weight;
} lens_field;

/* Vignetting factors of a field, as design programs have them: its rays fill the ellipse about (shift_x, shift_y) with
 * the half axes 1 - squeeze_x and 1 - squeeze_y, in units of the pupil's radius. All 0: the whole pupil. */
typedef struct lens_vignetting {
    double shift_x, shift_y, squeeze_x, squeeze_y;
} lens_vignetting;

typedef struct lens_wavelength {
    double nm, weight;
} lens_wavelength;

typedef struct lens_prescription {
    char title[256];
    double unit_mm;        /* 1: lengths are in mm */
    lens_surface *surface; /* without the object and the image */
    size_t count;
    int stop;                  /* the surface of the aperture stop; -1: not stated */
    double object_distance;    /* from the object to the first vertex, above 0; INFINITY */
    lens_medium object_medium; /* before the first surface */
    double image_radius;       /* of a curved image; 0: flat */
    double image_diameter;     /* 0: not stated */
    lens_aperture_kind aperture_kind;
    double aperture; /* by its kind; 0 for LENS_APERTURE_STOP */
    lens_field_kind field_kind;
    lens_field field[LENS_LIST_MAX];
    size_t field_count;                        /* at least 1: the axis */
    lens_vignetting vignetting[LENS_LIST_MAX]; /* of the fields */
    lens_wavelength wavelength[LENS_LIST_MAX];
    size_t wavelength_count;  /* at least 1: 587.5618 nm */
    size_t primary;           /* index of the primary wavelength */
    char coating[128];        /* of all faces of glass in air, as a material's coating; "": none */
    char note[LENS_NOTE_MAX]; /* what of the file was not read, or was assumed; "" for nothing */
    /* What a .zmx file holds that nothing here uses, for a writer of that format: lines "N TEXT", where N is the line
     * of their surface (lens_surface.line), 0 for the system, -1 after the surfaces. NULL: nothing. */
    char *kept;
} lens_prescription;

/* Without surfaces: mm, object at infinity, in air, on the axis, at 587.5618 nm. */
lens_prescription lens_prescription_empty(void);
void lens_prescription_release(lens_prescription *p);

/* The index relative to the surroundings: 1 for air. Pure. */
double lens_medium_index(const lens_medium *m, double lambda_nm);

/* Whether two media have the same index at all wavelengths. Pure. */
bool lens_media_match(const lens_medium *a, const lens_medium *b);

/* The sag of a surface at a radius along y; NaN beyond the end of its conic. Pure. */
double lens_surface_sag(const lens_surface *s, double rho);
/* The same at any point; a side that is not round goes on beyond its end. Pure. */
double lens_surface_height(const lens_surface *s, double x, double y);
even_asphere lens_surface_shape(const lens_surface *s);
/* The shape of a surface k times as large; what is not of its shape is unchanged but for its diameter. Pure. */
lens_surface lens_surface_scaled(const lens_surface *s, double k);
/* The curvature at the vertex, along y or x. Pure. */
double lens_surface_curvature(const lens_surface *s, bool along_x);
/* Whether all surfaces are round. Pure. */
bool lens_is_round(const lens_prescription *p);

bool lens_folds(const lens_surface *s);
/* Rotations in a frame of columns X, Y, Z with Z along the axis: to the normal of a fold mirror, and to the axis after
 * it. Pure. */
mat3 lens_tilt(const lens_surface *s);
mat3 lens_fold(const lens_surface *s);

/* The index after a surface, from that before it. Indices are below 0 where the light travels back, as in textbooks on
 * mirrors (Welford, Aberrations of Optical Systems). Pure. */
double lens_index_after(const lens_surface *s, double before, double lambda_nm);

/* The vignetting factors of the field with these coordinates; all 0 if it is none of the prescription's. Pure. */
lens_vignetting lens_vignetting_of(const lens_prescription *p, double x, double y);

/* shift_x, shift_y, squeeze_x and squeeze_y by number. Pure. */
double lens_vignetting_factor(const lens_vignetting *v, size_t k);

/* The largest distance of a field from the axis, in the unit of the fields. Pure. */
double lens_field_most(const lens_prescription *p);

/* Heights and slopes of a paraxial ray: y[i] at surface i; u[i] before it, u[count] after the last one. */
typedef struct lens_trail {
    double y[LENS_SURFACES_MAX], u[LENS_SURFACES_MAX + 1];
} lens_trail;

/* The paraxial properties at one wavelength, in the prescription's unit; distances along +y. Kingslake and Johnson,
 * Lens Design Fundamentals, on paraxial rays. */
typedef struct lens_first_order {
    double efl;            /* effective focal length, 1 / power; infinite for an afocal system */
    double back;           /* from the last vertex to the focus of an object at infinity */
    double front;          /* from the first vertex to the point whose image is at infinity */
    double image;          /* from the last vertex to the image of the object */
    double magnification;  /* of an object at a finite distance; 0 otherwise */
    double pupil;          /* from the first vertex to the entrance pupil */
    double pupil_diameter; /* of the entrance pupil; 0: not known */
    double exit_pupil;     /* from the last vertex to the exit pupil */
    double exit_diameter;  /* of the exit pupil; 0: not known */
    int stop;              /* the surface of the stop; where none is stated, that which an axial beam fills first */
    double stop_diameter;  /* of the beam on the axis at the stop surface; 0: not known */
    double stop_height;    /* of a ray at the stop, from an axial object, by its height in the entrance pupil */
    double direction;      /* 1 if light leaves along +y, -1 after an odd number of mirrors */
    double field_slope;    /* of the chief ray of the outermost field, in the object space; below 0 for heights */
    lens_trail marginal;   /* the ray on the axis through the edge of the stop */
    lens_trail chief;      /* of the outermost field */
} lens_first_order;

/* In the meridian of y; ..._x: in that of x. Pure. */
lens_first_order lens_first_order_of(const lens_prescription *p, double lambda_nm);
lens_first_order lens_first_order_x(const lens_prescription *p, double lambda_nm);

/* Fills what the file leaves open, with a note: the stop, which is the surface that a beam on the axis fills first
 * (it stays -1 where that surface's own edge is the aperture); clear diameters from the paraxial rays of axis and
 * outermost field (never below what the beam needs at the stop), and the distance of the image if the last
 * thickness is 0. */
void lens_prescription_complete(lens_prescription *p);

/* Files of lens prescriptions, by their ending:
 *   .zmx   sequential lens files of Zemax, in UTF-8 or UTF-16; surfaces STANDARD, EVENASPH, ODDASPHE, BICONICX and
 *          TOROIDAL, and coordinate breaks that fold the axis at flat mirrors
 *   .dat   tables of pbrt: lines of radius, thickness, index and diameter; radius 0 is the stop
 *   .csv   tables with a header (lens_files.c states its keys and columns), which hold everything
 * Ownership: the caller releases the prescription. Errors: STATUS_BAD_INPUT with the file, line, column and remedy. */

/* Where names of glasses are looked up before the catalogue of media: a scene's materials, then catalogue files (.agf).
 * Borrowed. */
typedef struct lens_glasses {
    const char *const *file; /* relative to the working folder */
    size_t count;
    const char *root; /* folder of all files that may be read (base/file.h); NULL: no restriction */
    const scene *own; /* a material that has a glass's name in lower case is that glass; NULL: none */
} lens_glasses;

/* The columns and keys of .csv files (lens_files.c). */
/* The last four keys are vignetting factors, which scenes do not hold. */
enum { LENS_COLUMNS = 32, LENS_KEYS = 16, LENS_SCENE_KEYS = 12 };
extern const char *const lens_column_words[LENS_COLUMNS], *const lens_key_words[LENS_KEYS];

/* Whether a path ends as such a file does. */
bool lens_file_named(const char *path);

/* Reads a file below glasses->root and completes it (lens_prescription_complete). */
status lens_file_read(const char *path, const lens_glasses *glasses, lens_prescription *out, diagnostic *why);
/* The same from its text; name is that of the file. */
status lens_file_parse(const char *name, const char *text, size_t size, const lens_glasses *glasses,
                       lens_prescription *out, diagnostic *why);

/* The medium of a word: "" or air; n/V, such as 1.5168/64.2; a six-digit glass code; a constant index; a material of
 * the scene, unless its index is that of a file; a glass of the files; or a medium of the catalogue in any usual
 * spelling (N-BK7). The remedy of the error has no position. */
status lens_medium_parse(const char *word, const lens_glasses *glasses, lens_medium *out, diagnostic *why);
/* The medium of n_d and V_d; V_d 0: a constant index. */
lens_medium lens_medium_of_numbers(double n_d, double V_d);
/* The same as a word that lens_medium_parse reads; text holds LENS_NAME_MAX bytes; returns text. */
char *lens_medium_text(const lens_medium *m, char *text);

/* Writes a prescription in the format of the path's ending. STATUS_BAD_INPUT if the format cannot hold it. */
status lens_file_write(const lens_prescription *p, const char *path, FILE *out, diagnostic *why);
/* What of the prescription the format does not hold, as words for a note; NULL for nothing. */
const char *lens_file_lacks(const lens_prescription *p, const char *path);

/* Lens systems as solids of a scene, and back. Each element is a solid of shape lens with its own medium; cemented
 * elements overlap, and the one with the higher priority has the true surface, so that no faces coincide.
 * Ownership: everything is copied. Errors: STATUS_BAD_INPUT with the remedy; the scene is then partly changed. */

/* Where and how a system is added to a scene. Its elements are NAME, NAME-2, NAME-3, ... in the order of the light;
 * all other solids follow NAME (scene/model/solids.h), so that the system moves and turns with it: NAME-stop,
 * NAME-hole-N for the holes of mirrors, NAME-mount-N and NAME-tube (rings that hold the elements, and the tube around
 * them), and NAME-screen at the image. */
typedef struct lens_placement {
    const char *name;
    vec3 position;     /* of the first vertex, scene units */
    vec3 rotation_deg; /* takes +y to the direction of the light; 0: upwards */
    double scale;      /* scene units per unit of the prescription */
    int64_t priority;  /* the lowest that its solids have */
    bool mount, screen;
    const lens_glasses *glasses; /* the files of glasses that the prescription names; their paths are relative to the
                                    scene's folder */
} lens_placement;

status lens_add_to_scene(scene *s, const lens_prescription *p, const lens_placement *at, diagnostic *why);

/* A new scene about a system named objective, whose light travels along +z from a chequered wall at the distance of
 * the object (50 focal lengths, if that is infinite): a camera behind the image that sees it through the exit pupil,
 * a beam for each field and wavelength (objective-field-N at the primary one, objective-field-N-line-W; lens_of_scene
 * reads them back) and a screen, both not visible. Lengths are in the prescription's unit. */
status lens_scene_create(const lens_prescription *p, const lens_glasses *glasses, scene **out, diagnostic *why);

/* Reads a system back from the solids of a scene: all solids of shape lens whose names begin with `name` (NULL or
 * "": all of the scene) must have one common axis, in the order of their positions along it; with mirrors, they
 * are in the order of the light, along the axis as mirrors fold it, and lenses that it meets again count again.
 * The stop is the cup NAME-stop, or any cup with floor 0 on the axis that is named stop or ends in -stop; the
 * image is at the solid that ends in -screen, or at the paraxial focus. Lengths are in scene units; unit_mm is
 * from render.unit_m. The scene's data must be loaded (scene_load) for media of files. Fields, wavelengths, the
 * distance of a near object and the aperture are those of its beams named NAME-field-..., whose power is the
 * weight of their wavelength, the first being the primary one; without beams they are the axis, render.lambda_nm,
 * a far object and the stop. *at, unless at is NULL: the frame of the system, and as its name that of the solid of
 * its stop, NULL for none, borrowed. */
status lens_of_scene(const scene *s, const char *name, lens_prescription *out, lens_placement *at, diagnostic *why);
