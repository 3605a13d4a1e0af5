/* The parameter table: every quantity that a person may turn is declared once, in params_table.c, and scene
 * files, --set, sweep axes, CSV headers and the manual's reference are all read from it.
 *
 * A parameter's path is group.name: `render.depth`, `camera.position`, `background.color`; for a mesh, a texture, a
 * light, a solid or a material the group is its name in the scene: `soup.count`, `lamp.intensity`, `vessel.ior`,
 * `glass.ior`. One element of a vector is `lamp.position.x` (.x .y .z, for colours .r .g .b). Setting a material's
 * field sets it for all the solids that refer to it; setting it by a solid's name sets it for that solid alone; the
 * last one set wins. Ownership: the table is constant. */
#pragma once

#include "scene/model/open.h"

typedef enum param_group {
    PARAM_RENDER,
    PARAM_CAMERA,
    PARAM_BACKGROUND,
    PARAM_MESH,
    PARAM_TEXTURE,
    PARAM_LIGHT,
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
    PARAM_WORD
} param_type;

typedef struct param {
    param_group group;
    const char *name; /* "depth"; the same word is the key in scene files */
    param_type type;
    const char *unit;           /* "px", "deg", "scene units", "" for ratios */
    double lowest, highest;     /* both allowed; of each element for vectors */
    bool above_lowest;          /* true: lowest itself is not allowed */
    const char *fallback;       /* the default, as text */
    const char *meaning;        /* one line, no full stop */
    const char *const *choices; /* PARAM_CHOICE: words by value, NULL at the end; switches are {"off", "on"},
                                 * and no, yes, false and true are read as these.
                                 * PARAM_INT: the only numbers allowed, or NULL */
    unsigned makers;            /* PARAM_MESH: 1 << mesh_maker, only listed and written for those; 0 = all */
    size_t offset;              /* within the group's struct */
    bool performance_only;      /* of how a frame is computed: the film is the same whatever it is */
    bool by_shape;              /* PARAM_SOLID: only solids have it whose shape's rule names it */
} param;

size_t param_count(void);
const param *param_at(size_t index);
/* "render", "camera", "background", "mesh", "texture", "light", "material", "solid" */
const char *param_group_name(param_group group);
/* The row of a group with that name, or NULL. PARAM_SOLID finds the material rows too, which a solid has by its
 * surface. */
const param *param_find(param_group group, const char *name);
/* "integer 1..65536", "number > 0, at most 179", "one of: sky, black", "3 numbers, each 0..1"; returns text. */
char *param_range_text(const param *row, char *text, size_t size);

/* A camera looks at its target or along its angles, by whichever was set last. When that changes, and in
 * scene_get, the other way of saying it is derived, so that setting one angle of an aimed camera leaves the
 * other as it was.
 *
 * Setting background.picture to a file makes background.kind picture; a kind that is set later wins.
 *
 * Setting a mesh's file makes its source file; a source (generate) that is set later wins.
 *
 * Setting a refractive index by ior makes medium `ior`; a medium that is set later wins. */

/* Sets one parameter from text, as on the command line: "8", "1.5", "sky", "0,2.75,-6" or "[0, 2.75, -6]".
 * STATUS_BAD_INPUT when no such path (remedy: the nearest right one), wrong type, out of range; the scene is
 * then unchanged. */
status scene_set(scene *s, const char *path, const char *value, diagnostic *why);
/* Splits "path=value" and sets it. */
status scene_set_assignment(scene *s, const char *assignment, diagnostic *why);

/* The value as text, in the form that scene_set takes, numbers with the fewest digits that read back the same.
 * Free it. */
status scene_get(const scene *s, const char *path, char **value, diagnostic *why);

/* Visits every parameter of the scene in a fixed order (table order in a group; lights, materials, solids in
 * scene order), with its full path and value as text. solid rows include those of its surface. Of the camera's
 * target and angles only what is in use is visited, and a picture that the background does not show is not, so
 * that setting all that is visited, in order, on a copy of the scene as its file gives it makes the same scene. Stops
 * when visit returns other than STATUS_OK, and returns that. */
typedef status param_visit(void *context, const char *path, const param *row, const char *value);
status scene_each_param(const scene *s, param_visit *visit, void *context);
