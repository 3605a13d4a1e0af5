/* Private to this folder: what readers of lens files share, lines divided into words that know their columns; and what
 * builds the solids of a system. */
#pragma once

#include "scene/lens/lens_prescription.h"
#include "scene/model/params.h"
#include "scene/model/place/placement.h"
#include "scene/model/solids.h"

enum { LENS_WORDS_MAX = 64 };

typedef struct lens_reader {
    const char *name;
    const lens_glasses *glasses;
    lens_prescription *p;
    size_t room;            /* of p->surface */
    size_t kept, kept_room; /* bytes of p->kept */
    long line;
    char *word[LENS_WORDS_MAX]; /* of the line; the text is changed */
    int column[LENS_WORDS_MAX], count;
    diagnostic *why;
} lens_reader;

/* STATUS_BAD_INPUT at a word of the line; word -1: at the line. */
status lens_wrong(const lens_reader *r, int word, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
/* Divides a line: at blanks, or at commas with the blanks around them removed. */
void lens_divide(lens_reader *r, char *line, bool commas);
/* Word i as a finite number; an error if it is missing or something else. */
status lens_number(const lens_reader *r, int i, const char *what, double *out);
/* Appends an empty surface, in air; NULL after an error. */
lens_surface *lens_append(lens_reader *r, status *code);
/* The medium of a word (lens_medium_parse), with its position. */
status lens_read_medium(const lens_reader *r, int i, const char *word, lens_medium *out);
/* The medium after a surface of a .zmx file, of the line GLAS name kind pickup n_d V_d ... */
status lens_read_glass(const lens_reader *r, lens_surface *s);
/* The name of its material in a scene: that of the glass in lower case, or glass-1-517-64-2 for numbers. */
void lens_material_name(const lens_medium *m, object_name name);
/* Adds a remark to the prescription's note, unless it is there. */
void lens_note(lens_prescription *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Adds an item to the remark "HEAD: item, item", unless it is there. */
void lens_note_item(lens_prescription *p, const char *head, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The number of at most 12 digits that differs from x by rounding alone; x if there is none. Pure. */
double lens_short_number(double x);

/* A list of one of the vignetting factors, one for each field (lens_vignetting_factor). */
status lens_read_vignetting(const lens_reader *r, size_t which);

status lens_read_zmx(lens_reader *r, char *text);

/* --- folded systems: lens_folds.c --- */

bool lens_is_flat(const lens_surface *s);
/* Makes it the same surface in a frame whose Z is the other way. */
void lens_turn_round(lens_surface *s);

/* A frame of columns X, Y, Z, and a point of the axis, which is along Z. */
typedef struct lens_way {
    mat3 frame;
    vec3 at;
} lens_way;

/* How a surface stands to the axis: its normal is along it or against it, or tilted, or its vertex is not on it. */
typedef enum lens_pose { LENS_AHEAD, LENS_BACK, LENS_TILTED, LENS_ASIDE } lens_pose;
/* distance: from w->at to the vertex, along the axis. */
lens_pose lens_way_pose(const lens_way *w, vec3 vertex, vec3 normal, double *distance);
/* Turns the frame at a tilted mirror, whose tilts it sets. */
void lens_way_fold(lens_way *w, vec3 normal, lens_surface *mirror);

/* A coordinate break: decentre x, y; tilts about x, y, z; order, 0: the decentre first. */
typedef struct lens_break {
    double number[6];
    bool given;
} lens_break;
/* Takes the breaks out of the surfaces, the first of which is the object and the last the image. */
status lens_take_breaks(lens_reader *r, const lens_break *breaks);
/* --- lens_zmx_rest.c: what a .zmx file holds besides the prescription --- */

/* A line whose word lens_zmx.c does not read. It is kept for a writer (lens_prescription.kept), and noted if it acts on
 * light; an error if the word is a mistake for one that is read. of: the surface's line, 0 for the system. */
status lens_zmx_other(lens_reader *r, long of, const char *line);
/* Keeps a line. */
status lens_zmx_keep(lens_reader *r, long of, const char *line);
/* Writes the kept lines of a surface, of the system (0) or after the surfaces (-1), but those of CURV, DIAM, VERS. */
void lens_zmx_put_kept(const lens_prescription *p, long of, FILE *out);
/* What follows the value in the kept line with that word (of the system: the word itself), or `usual`, and the end of
 * the line. */
void lens_zmx_put_tail(const lens_prescription *p, long of, const char *word, const char *usual, FILE *out);
/* Notes glasses of the catalogue of media whose maker is not among the catalogues that the file names. */
void lens_zmx_check_makers(lens_reader *r);
/* Checks that the last surface can be the image. has_distance: it has a line DISZ. */
status lens_zmx_check_image(lens_reader *r, bool has_distance);

/* Sets parameters of a scene by name, one after the other, until the first error. */

typedef struct lens_target {
    scene *s;
    status code; /* of the first step that failed */
    diagnostic *why;
} lens_target;

/* Adds a solid, whose shape is a word of files. */
void lens_add_solid(lens_target *t, const char *shape, const char *name);
/* Sets NAME.ROW (scene_set_property). */
void lens_put(lens_target *t, const char *name, const char *row, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void lens_put_number(lens_target *t, const char *name, const char *row, double value);
/* Whether an object of the group has the name. */
bool lens_has(const scene *s, param_group group, const char *name);

/* --- a system in a scene: lens_scene.c; names and numbers: lens_reader.c; its beams: lens_setup.c; its surfaces in the
 * order of the light: lens_folds.c --- */

/* Whether an object's name is that of a system or begins with it and a hyphen; system "": any. */
bool lens_belongs(const char *system, const char *name);
/* Twelve digits, so that a product that was divided again is the published number. */
double lens_tidy(double x);
/* The fields, wavelengths, distance of the object and aperture of the system's beams; at: its first surface. */
void lens_read_beams(const scene *s, const char *system, const lens_placement *at, lens_prescription *p);

/* A lens of the scene, with its place on the axis. */
typedef struct placed_lens {
    const solid *of;
    double y_1, y_2;
    size_t order; /* in the scene */
    bool mirror;
    double hole; /* of a mirror: its diameter */
    int leg;     /* on which the light has passed it, from 1; 0: not yet */
    bool cemented;
} placed_lens;

typedef struct lens_finder {
    const scene *s;
    const char *name;
    placed_lens lens[LENS_SURFACES_MAX];
    size_t count;
    vec3 origin, axis;
    const solid *stop, *screen;
    double first; /* the height of the first surface, which may be the plane of the stop */
    bool mirrors;
    /* while the surfaces are read: the present part of the axis, at the last vertex; the height of that vertex, and the
     * direction of the light, 1 or -1, in the unfolded system */
    lens_way way;
    int leg;
    double y, direction;
    lens_prescription *p;
    diagnostic *why;
} lens_finder;

/* The factor of a solid's own and its leader's scale. */
double lens_size_of(const solid *of);
/* Its distance from the first lens, along that one's axis. */
double lens_along(const lens_finder *f, const solid *of);
lens_surface lens_side_of(const lens_finder *f, const placed_lens *l, int side);
/* STATUS_BAD_INPUT about a solid. */
status lens_refuse(const lens_finder *f, const solid *of, const char *remedy, const char *what);
status lens_read_surfaces(lens_finder *f);

/* --- the solids of a system: lens_solids.c; lens_parts.c for their media and what holds them --- */

/* Fractions of a diameter: by how much the rim of an overlapped element is smaller, so that no rims coincide; the
 * clearance of the tube. */
#define LENS_RIM_GAP 1e-6
#define LENS_TUBE_CLEARANCE 1.02

/* A straight part of the axis: the point at height y is at + turn (0, y, 0), in the prescription's unit. */
typedef struct lens_leg {
    mat3 turn;
    vec3 at;
} lens_leg;

/* An element between two surfaces, in the order along the axis. */
typedef struct lens_element {
    size_t front, back;        /* indices of surfaces: side 1, side 2 */
    double y_1, y_2;           /* of their vertices, in the prescription's unit */
    double length;             /* between them, as published */
    double diameter;           /* of the rim */
    double before, after;      /* by how much sides 1 and 2 are moved into the neighbours to which it is cemented */
    int64_t rank;              /* priority above that of the others it is cemented to */
    const lens_medium *medium; /* NULL: a mirror */
    double direction;          /* of the light before a mirror */
    lens_leg leg;
    object_name name;
} lens_element;

typedef struct lens_builder {
    lens_target t;
    double leader; /* height of the first solid */
    const lens_prescription *p;
    const lens_placement *at;
    mat3 turn;
    double y[LENS_SURFACES_MAX + 1]; /* of the vertices, and of the image, as if no mirror was tilted */
    lens_leg leg[LENS_SURFACES_MAX + 1];
    lens_element element[LENS_SURFACES_MAX];
    size_t count;
} lens_builder;

/* NAME-rest. */
void lens_part_name(const lens_builder *b, object_name name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Places a solid at a height along the axis. The first one leads, the others follow it. */
void lens_put_at(lens_builder *b, const char *name, const lens_leg *leg, double y);
/* The name of the material of a medium; the scene's own material of that name has precedence. */
void lens_medium_material(lens_builder *b, const lens_medium *m, object_name name);
/* Coats the sides of an element that are in air, with the prescription's coating. */
void lens_coat(lens_builder *b, const lens_element *e);
/* The medium of a solid's material. */
status lens_medium_of(const scene *s, const solid *of, lens_medium *out, diagnostic *why);
/* The name of the material of mirrors. */
const char *lens_mirror_material(lens_builder *b);
/* A plug of the surrounding medium in the hole of a mirror. */
void lens_add_hole(lens_builder *b, const lens_element *e, double hole);
/* The name of a black opaque material for stops and mounts. */
const char *lens_black(lens_builder *b);
/* The height of a surface at a radius, within its diameter, and at an angle from y to x, 0 to 90 degrees, which
 * counts if it is not round. */
double lens_side_height_at(const lens_builder *b, size_t surface, double rho, double deg);
/* The higher or the lower one of those in both meridians. */
double lens_side_height(const lens_builder *b, size_t surface, double rho, bool highest);
bool lens_is_air(const lens_medium *m);
/* Whether surface i is between glass and air. */
bool lens_side_in_air(const lens_prescription *p, size_t i);
/* Removes and notes the bevels of other surfaces, which no element has. */
void lens_drop_bevels(lens_prescription *p);
/* The half diagonal of the image of the outermost field. */
double lens_image_height(const lens_prescription *p, const lens_first_order *f);
/* In air, a ring in the plane of the stop, which yields to glass. On a surface of glass, a ring in the air at the edge
 * of the clear diameter, which cuts glass beyond it. outer: its outer radius. */
void lens_add_stop(lens_builder *b, double outer);
void lens_add_mounts(lens_builder *b, double outer);
/* A white solid whose side towards the light is the image's surface. */
void lens_add_screen(lens_builder *b);
