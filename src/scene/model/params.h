/* The parameter table: every user-settable quantity is declared once, in params_table.c; the keys of scene files,
 * --set, the axes of studies, CSV headers and the manual all follow from it.
 *
 * A parameter's path is group.name: `render.depth`, `camera.position`, `background.color`; for a mesh, a texture,
 * data, a light, a beam, a solid or a material the group is its name in the scene: `soup.count`, `lamp.intensity`,
 * `vessel.ior`, `glass.ior`. One element of a vector is `lamp.position.x` (.x .y .z, for colours .r .g .b). Setting a
 * material's field applies to all solids with that material; setting it by a solid's name applies to that solid only;
 * the last setting wins. Ownership: the table is constant. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/solids.h"
#include <stdint.h>

typedef enum param_group {
    PARAM_RENDER,
    PARAM_CAMERA,
    PARAM_BACKGROUND,
    PARAM_MESH,
    PARAM_TEXTURE,
    PARAM_DATA,
    PARAM_LIGHT,
    PARAM_BEAM,
    PARAM_MATERIAL,
    PARAM_SOLID,
    PARAM_GROUP_COUNT
} param_group;
typedef enum param_type {
    PARAM_INT,
    PARAM_REAL,
    PARAM_CHOICE,
    PARAM_VECTOR,
    PARAM_COLOR,
    PARAM_LIST,
    PARAM_PATH,
    PARAM_WORD,
    PARAM_LAYERS
} param_type;

/* The useful part of a range, for a slider. */
typedef struct param_slider {
    double lowest, highest; /* lowest == highest: not declared */
    double step;            /* 1 for integers; 0: continuous, by the logarithm */
    double log_from;        /* above 0: logarithmic from this value on; below it, only a lowest of 0 */
} param_slider;

typedef struct param {
    param_group group;
    const char *name; /* "depth"; also the key in scene files */
    param_type type;
    const char *unit;           /* "px", "deg", "scene units", "" for ratios */
    double lowest, highest;     /* both inclusive; for each element of vectors */
    bool above_lowest;          /* true: lowest itself is excluded */
    const char *fallback;       /* the default, as text */
    const char *meaning;        /* one line, no period */
    const char *const *choices; /* PARAM_CHOICE: words by value, NULL at the end; switches are {"off", "on"}, and no,
                                   yes, false and true are accepted. PARAM_INT: the only allowed numbers, or NULL */
    unsigned makers;            /* PARAM_MESH: bits 1 << mesh_maker, the generators that have the parameter; 0 = all */
    const char *automatic;      /* PARAM_INT: a word for a value outside lowest .. highest; NULL: none */
    int64_t automatic_value;    /* the value that `automatic` stands for */
    size_t offset;              /* in the group's struct */
    const char *names;          /* PARAM_WORD: what kind of object it names ("texture"); NULL: any text */
    param_slider slider;        /* declared only if the slider that param_slider_of derives is unsuitable */
    bool not_zero;              /* 0, or a 0 among the elements, is out of range */
    bool coefficient;           /* PARAM_COLOR: an absorption coefficient of each channel, not a colour */
    bool performance_only;      /* affects only performance: the film does not depend on it */
    bool by_shape;              /* PARAM_SOLID: only for solids whose shape rule lists it */
    bool by_chance;             /* affects only films of random paths: a study's row does not identify its cell by it if
                                   the integrator is another one */
    const char *first_default;  /* the default of the first version that had the parameter, if it has changed: a study's
                                   row with this value omits it in the identity of its cell; NULL: fallback */
} param;

size_t param_count(void);
const param *param_at(size_t index);
/* "render", "camera", "background", "mesh", "texture", "data", "light", "beam", "material", "solid" */
const char *param_group_name(param_group group);
/* The row of a group by its name, or NULL. PARAM_SOLID also finds material rows, which apply to a solid's surface. */
const param *param_find(param_group group, const char *name);
/* Whether a parameter has a slider: numbers, vectors and colours. */
bool param_has_slider(const param *row);
/* The slider of a value: the range, or a useful part of it that contains the default, the value and, unless NULL, the
 * initial value. The elements of a vector have the same slider. Values are texts in the form of scene_get. Pure. */
param_slider param_slider_of(const param *row, const char *initial, const char *value);

/* How well a row matches all words of a search. Words may be in the path, the meaning, the choices, or in everyday
 * language ("brightness" for intensity). PARAM_IN_NAME: parts of the path begin with the words; PARAM_IN_PATH: the path
 * contains them or their synonyms; PARAM_IN_TEXT: a word is only in the meaning or the choices; PARAM_NO_MATCH: a word
 * is missing. Pure. */
typedef enum param_match { PARAM_IN_NAME, PARAM_IN_PATH, PARAM_IN_TEXT, PARAM_NO_MATCH } param_match;
param_match param_matches(const param *row, const char *path, const char *words);

/* "integer 1..65536", "number > 0, at most 179", "one of: sky, black", "3 numbers, each 0..1"; returns text. */
char *param_range_text(const param *row, char *text, size_t size);

/* A camera is aimed at its target or along its angles, whichever was set last. The unused ones are derived in
 * scene_get, and when the aim changes, so that setting one angle of an aimed camera keeps the other angle.
 *
 * Setting background.image to a file sets background.kind to image; a kind that is set later wins.
 *
 * Setting a mesh's file selects it as the source; a generator that is set later wins.
 *
 * Setting ior sets medium to `ior`; a medium that is set later wins. */

/* Sets one parameter from text, as on the command line: "8", "1.5", "sky", "0,2.75,-6" or "[0, 2.75, -6]".
 * STATUS_BAD_INPUT for an unknown path (remedy: the nearest valid one), a wrong type or a value out of range; the scene
 * is then unchanged. */
status scene_set(scene *s, const char *path, const char *value, diagnostic *why);
/* Sets a parameter from "path=value". */
status scene_set_assignment(scene *s, const char *assignment, diagnostic *why);

/* The value as text, in the form that scene_set accepts, numbers with the fewest digits that round-trip. Free it. */
status scene_get(const scene *s, const char *path, char **value, diagnostic *why);

/* Visits every parameter of the scene in a fixed order (rows in table order, objects in scene order), with its full
 * path and its value as text. The rows of a solid include those of its surface. Rows that are not in use are skipped
 * (the unused direction of the camera, an unused background image or file of a mesh, the parameters of slimes for other
 * meshes), so that setting all visited values in order turns a copy of the scene as read from its file into this scene.
 * Stops at the first status other than STATUS_OK, and returns it. */
typedef status param_visit(void *context, const char *path, const param *row, const char *value);
status scene_each_param(const scene *s, param_visit *visit, void *context);

/* The defaults of all rows as values (param_value). */
typedef struct param_defaults param_defaults;
/* Likewise, without the parameters that have these defaults. but: NULL for none. */
status scene_each_param_but(const scene *s, const param_defaults *but, param_visit *visit, void *context);

/* --- the target of a path: `lamp.position.x` refers to the row, the light and the element --- */

typedef struct param_place {
    const param *row;
    param_group object_group; /* from the path's first word: PARAM_SOLID for vessel.ior, whose row is a material's */
    size_t index;             /* index of the object in its group; 0 for render, camera and background */
    int element;              /* 0..2, or -1 for the whole value */
} param_place;

/* Visits the parameters of the objects of one group as scene_each_param does, by place. */
typedef status param_place_visit(void *context, const param_place *at);
status param_place_each(const scene *s, param_group group, param_place_visit *visit, void *context);

/* Some parameters of a scene, such as those of the objects that a page shows. Asked with row NULL: whether any
 * parameter of that object is wanted, so that a scene of many objects is not formatted for a few. */
typedef struct param_selection {
    bool (*wants)(const void *context, const scene *s, const param_place *at);
    const void *context;
} param_selection;
/* As scene_each_param, only those of the selection; of: NULL for all. */
status scene_each_param_of(const scene *s, const param_selection *of, param_visit *visit, void *context);

/* The value of a place as text, in the form of scene_get. Newly allocated; NULL if memory runs out. */
char *param_place_text(const scene *s, const param_place *at);
/* Whether two objects, whose structs are `one` and `other`, have values of a row with the same text. */
bool param_values_match(const param *row, const void *one, const void *other);

/* Finds the target of a path. STATUS_BAD_INPUT for an invalid path, with the nearest valid path as remedy. */
status param_place_find(const scene *s, const char *path, param_place *out, diagnostic *why);

/* scene_set for a place that is known; path is its path, for messages. */
status param_place_set(scene *s, const param_place *at, const char *path, const char *value, diagnostic *why);

/* Finds an object by name, or camera, background or render; out->row is NULL, out->element is -1. */
status param_place_find_object(const scene *s, const char *name, param_place *out, diagnostic *why);

/* Whether the film can depend on a parameter: false for parameters that affect only performance or how an image is
 * shown, and for parameters of a beam that does not light the scene, except NAME.lights. */
bool scene_film_depends_on(const scene *s, const char *path);

/* Whether the row applies to the solid (its shape has that dimension). */
bool solid_has(const solid *owner, const param *row);

/* The name of an object; "render", "camera" or "background" for these groups. */
const char *param_place_group_name(const scene *s, param_group group, size_t index);

/* The number of the scene's objects in a group; 1 for render, camera and background. */
size_t param_place_group_size(const scene *s, param_group group);

/* The word of a shape: "sphere". */
const char *shape_name(shape_kind kind);

/* The value of one row: from text, to text, and in the struct of its group. Basis of params.h. Ownership:
 * param_value_text returns newly allocated text; a PARAM_PATH field owns its text. */

typedef union param_value {
    int64_t integer;
    double real;
    vec3 vector;
    number_list list;
    char *path;
    char word[SCENE_NAME_MAX + 1];
    char layers[COATING_MAX + 1];
} param_value;

/* Parses and checks text; label is the parameter in messages. element -1 for the whole value, 0..2 for one element of a
 * vector or colour, which is returned in real. A path is newly allocated. */
status param_value_parse(const param *row, int element, const char *label, const char *text, param_value *out,
                         diagnostic *why);

/* Stores a value; field is the address of the row's field. Takes ownership of a path. */
void param_value_store(const param *row, int element, void *field, param_value value);

/* The value as text, or NULL if memory runs out. */
char *param_value_text(const param *row, int element, const void *field);

/* Writes the remedy for an invalid value, such as "give an integer 0..64", for the row or for one element of a vector.
 * Returns text. */
char *param_remedy(const param *row, bool one_element, char *text, size_t size);

/* The row's default in the form of param_value_text. Newly allocated; NULL if memory runs out. */
char *param_default_text(const param *row);
/* Likewise, the row's first default (param.first_default). */
char *param_first_default_text(const param *row);

/* The first defaults of all rows, parsed once for callers that compare many values. NULL if memory runs out; the caller
 * destroys it. */
param_defaults *param_first_defaults_create(void);
void param_first_defaults_destroy(param_defaults *old);
/* Whether the row's field has the row's default: exactly if param_value_text is the same for both. */
bool param_defaults_hold(const param_defaults *d, const param *row, const void *field);

/* Sets every field of the group's rows in *base to its default. Path fields must be NULL or owned text. */
status param_set_defaults(param_group group, void *base, diagnostic *why);
