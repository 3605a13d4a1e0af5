/* The prescription of a lens system: its surfaces in the order in which light meets them, as an optical designer
 * writes them. Lens systems of scenes, files of prescriptions and reports all use this structure.
 *
 * Conventions, those of optical design: light travels along +y of the system's frame, from the first surface to the
 * last; a radius is above 0 if its centre is on the image's side of the vertex; a thickness is the distance along +y
 * to the next vertex, and is below 0 where the light travels back after a mirror. Lengths are in the unit of the
 * prescription, unit_mm millimetres.
 *
 * Ownership: lens_prescription_release frees the surfaces; names are within the structure. A law's optical data are
 * borrowed from the scene or held by the caller. Errors: STATUS_BAD_INPUT with file, line, column and remedy. */
#pragma once

#include "scene/model/medium.h"
#include <stdbool.h>
#include <stddef.h>

/* EVEN_TERMS: coefficients of r^4, r^6, ... r^20. */
enum { LENS_EVEN_TERMS = 9, LENS_SURFACES_MAX = 200, LENS_LIST_MAX = 24, LENS_NAME_MAX = 64 };

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
    int glass_file;           /* LENS_DATA: its catalogue file (lens_glasses); -1: an entry of the scene's data */
    double n_d, V_d;          /* for LENS_MODEL, and where a file states them; V_d is 0 for none */
    index_law law;            /* by which lens_medium_index computes the index; not for LENS_AIR. Of a glass in a
                                 catalogue file: by its n_d and V_d, until the scene has loaded its data */
    double around;            /* index of the surroundings if they are not air; 0: air */
} lens_medium;

typedef struct lens_surface {
    char name[LENS_NAME_MAX];     /* the file's comment; "" for none */
    double radius;                /* 0: flat */
    double conic;                 /* conic constant k; 0: sphere */
    double even[LENS_EVEN_TERMS]; /* sag = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + even[0] r^4 + even[1] r^6 + ... */
    double thickness;             /* to the next surface; after the last surface, to the image */
    lens_medium medium;           /* after the surface; for a mirror that before it */
    double diameter;              /* clear diameter; 0: not stated */
    double hole;                  /* diameter of the hole in a mirror; 0: none */
    bool mirror;
    long line; /* in the file; 0: none */
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
    size_t field_count; /* at least 1: the axis */
    lens_wavelength wavelength[LENS_LIST_MAX];
    size_t wavelength_count; /* at least 1: 587.5618 nm */
    size_t primary;          /* index of the primary wavelength */
    char note[512];          /* what of the file was not read; "" for nothing */
} lens_prescription;

/* Without surfaces: mm, object at infinity, in air, on the axis, at 587.5618 nm. */
lens_prescription lens_prescription_empty(void);
void lens_prescription_release(lens_prescription *p);

/* The index relative to the surroundings: 1 for air. Pure. */
double lens_medium_index(const lens_medium *m, double lambda_nm);

/* Whether two media have the same index at all wavelengths. Pure. */
bool lens_media_match(const lens_medium *a, const lens_medium *b);

/* The sag of a surface at a radius; NaN beyond the end of its conic. Pure. */
double lens_surface_sag(const lens_surface *s, double rho);

/* The paraxial properties at one wavelength, in the prescription's unit; distances along +y. Kingslake and Johnson,
 * Lens Design Fundamentals, 2nd ed., chapter 3. */
typedef struct lens_first_order {
    double efl;            /* effective focal length, 1 / power; infinite for an afocal system */
    double back;           /* from the last vertex to the focus of an object at infinity */
    double image;          /* from the last vertex to the image of the object */
    double magnification;  /* of an object at a finite distance; 0 otherwise */
    double pupil;          /* from the first vertex to the entrance pupil */
    double pupil_diameter; /* of the entrance pupil; 0: not known */
    double exit_pupil;     /* from the last vertex to the exit pupil */
    double stop_diameter;  /* of the beam on the axis at the stop surface; 0: not known */
    double direction;      /* 1 if light leaves along +y, -1 after an odd number of mirrors */
    double field_slope;    /* of the chief ray of the outermost field, in the object space */
    /* by surface: heights of the marginal ray on the axis, and of the chief ray of the outermost field */
    double marginal[LENS_SURFACES_MAX], chief[LENS_SURFACES_MAX];
} lens_first_order;

/* A prescription without a stated stop has it at its first surface. Pure. */
lens_first_order lens_first_order_of(const lens_prescription *p, double lambda_nm);

/* Fills what the file leaves open: clear diameters from the paraxial rays of axis and outermost field (never below
 * what the beam needs at the stop), and the distance of the image if the last thickness is 0. */
void lens_prescription_complete(lens_prescription *p);
