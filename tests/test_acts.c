/* Every parameter has an effect, or a note explains why not: for each shipped scene and each parameter that `cuvette
 * params SCENE` prints, other legal values change the film, or a note states why none does, or the table marks the
 * parameter as not affecting the image. A note is proved by its remedy: once the remedy is applied, the parameter
 * changes the film. New parameters of the table are covered automatically. ACTS_SCENE=rod.yaml tests that scene alone.
 * ACTS_SLICE=2/12 tests every twelfth scene, mode, condition and setting from the third on, and writes the notes that
 * it saw to the file ACTS_NOTES; ACTS_SLICE=notes tests that the slices of that file have proved each of them.
 * ACTS_VERBOSE=1 lists parameters of which only one value has an effect, and remedies that do not help. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "acts_fixture.h"
#include "lint/inert.h"
#include "scene/model/medium.h"

#include <glob.h>
#include <pthread.h>
#include <stdatomic.h>

enum { RULES_MAX = 500, JOBS_MAX = 240, TEXT_MAX = 1 << 14 };
enum { ATTEMPTS = 2 };   /* of proving a condition in one scene */
enum { FEW_VALUES = 3 }; /* tried in each scene of a parameter whose note is a condition of the table */

/* How often each condition was reported for a parameter of this name, how often its remedy was tried, and how often it
 * proved it. */
typedef struct rule_count {
    const char *rule, *name;
    int reported, attempts, proved;
    char where[240];
} rule_count;

typedef struct account {
    const char *path;
    int tried, acting, by_one, noted, refused, marked, bad;
    rule_count rules[RULES_MAX];
    int rule_count;
    char text[TEXT_MAX]; /* the failures, one a line */
} account;

typedef struct visitor {
    acts *a;
    account *out;
} visitor;

static void complain(account *out, const char *path, const char *what, const char *more)
{
    const size_t used = strlen(out->text);
    snprintf(out->text + used, sizeof out->text - used, "# %s: %s: %s%s%s\n", out->path, path, what, more ? ": " : "",
             more ? more : "");
    out->bad++;
}

static rule_count *count_of(account *out, const char *rule, const char *name)
{
    for (int i = 0; i < out->rule_count; i++)
        if (strcmp(out->rules[i].rule, rule) == 0 && strcmp(out->rules[i].name, name) == 0)
            return &out->rules[i];
    assert_true(out->rule_count < RULES_MAX);
    out->rules[out->rule_count] = (rule_count){.rule = rule, .name = name};
    return &out->rules[out->rule_count++];
}

/* The conditions that some scene has proved: one proof is enough, and it takes longer than all else here. Which scene
 * proves a condition depends on the order in time, whether one does not. */
static struct {
    pthread_mutex_t lock;
    struct {
        const char *rule, *name;
    } all[RULES_MAX];
    int count;
} proofs = {.lock = PTHREAD_MUTEX_INITIALIZER};

static bool is_proved(const char *rule, const char *name)
{
    bool found = false;
    pthread_mutex_lock(&proofs.lock);
    for (int i = 0; i < proofs.count && !found; i++)
        found = strcmp(proofs.all[i].rule, rule) == 0 && strcmp(proofs.all[i].name, name) == 0;
    pthread_mutex_unlock(&proofs.lock);
    return found;
}

static void prove(rule_count *rule)
{
    rule->proved++;
    if (is_proved(rule->rule, rule->name))
        return;
    pthread_mutex_lock(&proofs.lock);
    const int i = proofs.count++;
    assert_true(i < RULES_MAX);
    proofs.all[i].rule = rule->rule, proofs.all[i].name = rule->name;
    pthread_mutex_unlock(&proofs.lock);
}

/* Applies the remedy of the note, then that of the next note, until there is none: then the parameter must change the
 * film. */
static bool remedy_works(const acts *a, const char *path, const param *row, const inert_answer *first)
{
    enum { STEPS = 4 };
    inert_answer answer = *first;
    acts helped = {.s = NULL};
    scene *s = scene_clone(a->s);
    bool inert = true;
    for (int i = 0; i < STEPS && inert && s; i++) {
        if (!strchr(answer.note.remedy, '=') || !acts_set_all(s, answer.note.remedy, NULL))
            break;
        inert = inert_ask(s, path, NULL, &answer);
    }
    if (!s || inert || !acts_of(s, &helped, NULL)) {
        if (inert)
            scene_destroy(s);
        return false;
    }
    acts_values v;
    char *now = NULL;
    bool works = scene_get(helped.s, path, &now, NULL) == STATUS_OK;
    if (works) {
        acts_values_of(helped.s, row, now, &v);
        works = acts_try_sizes(&helped, path, &v, 1).changed > 0;
    }
    free(now);
    acts_close(&helped);
    return works;
}

/* Drops indices of special meaning: where no light is refracted, an index above MIRROR_IOR still makes a mirror, and
 * where no ray continues, the surroundings' index still removes a surface. */
static void drop_special_indices(const inert_answer *answer, const param *row, acts_values *v)
{
    if (strcmp(row->name, "ior") != 0 ||
        (strcmp(answer->rule, "straight") != 0 && strcmp(answer->rule, "not-bent") != 0))
        return;
    for (int i = 0; i < v->count;) {
        const double n = strtod(v->text[i], NULL);
        if (n == 1.0 || n > MIRROR_IOR)
            memmove(v->text[i], v->text[--v->count], sizeof v->text[i]);
        else
            i++;
    }
}

/* Of the table, a row of which has a proof of its own with all values. */
static bool is_condition(const char *rule)
{
    return rule[strcspn(rule, "=!>")] != 0;
}

static void judge_note(visitor *x, const char *path, const param *row, acts_values *v, const inert_answer *answer)
{
    char line[NOTE_LINE_MAX];
    drop_special_indices(answer, row, v);
    if (is_condition(answer->rule) && v->count > FEW_VALUES)
        v->count = FEW_VALUES;
    const acts_outcome o = acts_try(x->a, path, v, 0, 1);
    rule_count *rule = count_of(x->out, answer->rule, row->name);
    x->out->noted++;
    rule->reported++;
    if (o.changed > 0)
        complain(x->out, path, "acts, and yet a note says that it does not",
                 note_line(&answer->note, line, sizeof line));
    if (strcmp(answer->note.place, path) != 0 || !answer->note.text[0] || !answer->note.remedy[0])
        complain(x->out, path, "the note lacks its place, text or remedy", note_line(&answer->note, line, sizeof line));
    if (rule->attempts >= ATTEMPTS || is_proved(answer->rule, row->name))
        return;
    rule->attempts++;
    if (remedy_works(x->a, path, row, answer)) {
        prove(rule);
        const char *slash = strrchr(x->out->path, '/');
        snprintf(rule->where, sizeof rule->where, "%.90s %.120s", slash ? slash + 1 : x->out->path, path);
    } else if (getenv("ACTS_VERBOSE")) {
        printf("# %s %s: not proved here: %s\n", x->out->path, path, note_line(&answer->note, line, sizeof line));
    }
}

/* Parameters marked as not affecting the image: no value may change the film. */
static void judge_mark(visitor *x, const char *path, const acts_values *v)
{
    x->out->marked++;
    if (acts_try(x->a, path, v, 0, 1).changed > 0)
        complain(x->out, path, "changes the film, and yet the table marks it as not affecting it", NULL);
}

static void judge_act(visitor *x, const char *path, const acts_values *v)
{
    const acts_outcome o = acts_try_sizes(x->a, path, v, 2);
    char text[DIAGNOSTIC_TEXT_MAX];
    if (o.changed > 0) {
        x->out->acting++;
        if (o.changed < 2 && o.legal > 1) {
            x->out->by_one++;
            if (getenv("ACTS_VERBOSE"))
                printf("# %s %s: one value of %d acts\n", x->out->path, path, o.legal);
        }
    } else if (o.legal == 0 && o.why.remedy[0])
        x->out->refused++;
    else
        complain(x->out, path, "unexplained: no other value changes the film, and nothing says why",
                 o.legal == 0 ? diagnostic_text(&o.why, text, sizeof text) : NULL);
}

static status try_parameter(void *context, const char *path, const param *row, const char *value)
{
    visitor *x = context;
    acts_values v;
    inert_answer answer;
    acts_values_of(x->a->s, row, value, &v);
    x->out->tried++;
    if (!scene_film_depends_on(x->a->s, path))
        judge_mark(x, path, &v);
    else if (acts_ask(x->a, path, &answer))
        judge_note(x, path, row, &v, &answer);
    else
        judge_act(x, path, &v);
    return STATUS_OK;
}

/* --- jobs on two threads, each with its own account --- */

/* Which jobs run: those whose number has the remainder `at` when divided by `of`; none if `of` is 0. */
static struct {
    int at, of;
} slice = {0, 1};

static void read_slice(void)
{
    const char *text = getenv("ACTS_SLICE");
    if (!text || !*text)
        return;
    slice.at = slice.of = 0;
    if (strcmp(text, "notes") != 0 &&
        (sscanf(text, "%d/%d", &slice.at, &slice.of) != 2 || slice.at < 0 || slice.at >= slice.of)) {
        fprintf(stderr, "test_acts: ACTS_SLICE=%s is neither K/N with 0 <= K < N nor \"notes\"\n", text);
        exit(2);
    }
}

typedef void job(int number, account *out);
typedef struct bench {
    job *job;
    account *accounts;
    int count;
    atomic_int next;
} bench;

static account accounts[JOBS_MAX], all;

static void *work(void *context)
{
    bench *b = context;
    for (int i; (i = atomic_fetch_add(&b->next, 1)) < b->count;)
        if (slice.of > 0 && i % slice.of == slice.at)
            b->job(i, &b->accounts[i]);
    return NULL;
}

static void run(job *one, int count)
{
    pthread_t other;
    bench b = {.job = one, .accounts = accounts, .count = count};
    assert_true(count <= JOBS_MAX);
    memset(accounts, 0, sizeof accounts);
    assert_int_equal(pthread_create(&other, NULL, work, &b), 0);
    work(&b);
    pthread_join(other, NULL);
}

static glob_t shipped;

static void try_scene(int number, account *out)
{
    acts a;
    diagnostic why = {.what = ""};
    out->path = shipped.gl_pathv[number];
    if (getenv("ACTS_SCENE") && !strstr(out->path, getenv("ACTS_SCENE")))
        return;
    if (!acts_open(out->path, &a, &why)) {
        complain(out, "", "cannot be rendered", why.what);
        return;
    }
    visitor x = {&a, out};
    scene_each_param(a.s, try_parameter, &x);
    acts_close(&a);
}

/* Render modes in which light continues from surfaces. */
static const char *const modes[] = {
    "render.integrator=path render.paths=4",
    "render.integrator=path render.paths=4 render.polarisation=on",
    "render.integrator=aov",
    "render.integrator=aov render.layer=albedo",
    "render.integrator=aov liquid.capillary_length=0.1",
    "render.transmission=simple clear.transparency=0.8 clear.reflectivity=0.1",
    "render.weights=constant clear.transparency=0.8 clear.reflectivity=0.1",
    "render.spectrum=spectral render.wavelengths=4",
    "render.polarisation=on",
    "render.radiance=basic",
    "render.caustics=photons render.photons=2000",
};

static bool open_with(const char *name, const char *assignments, acts *out, diagnostic *why);

static void try_mode(int number, account *out)
{
    acts a;
    diagnostic why = {.what = ""};
    out->path = modes[number];
    if (!open_with("rod", modes[number], &a, &why)) {
        complain(out, "", "cannot be rendered", why.what);
        return;
    }
    visitor x = {&a, out};
    scene_each_param(a.s, try_parameter, &x);
    acts_close(&a);
}

/* --- facts that no shipped scene has, and remedies that are not an assignment --- */

/* Under these assignments the rule is reported for the parameter. works: the rule's remedy makes the parameter
 * effective. */
typedef struct condition {
    const char *scene, *assignments, *path, *rule;
    bool works;
} condition;
static const condition conditions[] = {
    {"rod", "lamp.intensity=0", "render.shadows", "no-lamp", true},
    {"rod", "lamp.intensity=0 background.ambient=0,0,0", "render.caustics", "no-lamp", true},
    {"rod", "render.caustics=photons lamp.intensity=0", "render.photons", "no-lamp", true},
    {"rod", "render.caustics=photons", "render.radiance", "caustics-radiance", true},
    {"rod", "lamp.intensity=0", "rod.diffuse", "no-lamp", true},
    {"rod", "lamp.intensity=0", "rod.specular", "no-lamp", true},
    {"rod", "render.integrator=raycast", "render.depth", "no-tree", true},
    {"rod", "render.integrator=raycast", "render.beyond", "no-tree", true},
    {"rod", "clear.transparency=0", "render.transmission", "no-clear", true},
    {"rod", "rod.visible=off vessel.visible=off liquid.visible=off ground.visible=off", "render.transmission",
     "no-clear", false},
    {"rod", "clear.transparency=0", "render.lambda_nm", "no-clear", true},
    {"rod", "clear.transparency=0", "background.medium", "no-clear", true},
    {"absorber", "liquid.transparency=0", "render.polarisation", "no-branches", true},
    {"rod", "rod.priority=0 rod.position=0,1,0 rod.size=0.1,0.5,0.1", "rod.color", "covered", true},
    {"rod", "lamp.color=0,0,0", "lamp.intensity", "dark-lamp", true},
    {"rod", "lamp.kind=rectangle", "lamp.width", "sphere-lamp", true},
    {"rod", "lamp.kind=rectangle", "lamp.height", "sphere-lamp", true},
    {"rod", "lamp.kind=rectangle lamp.width=3", "lamp.roll_deg", "sphere-lamp", true},
    {"rod", "lamp.kind=sun", "lamp.angular_diameter_deg", "sphere-lamp", true},
    {"rod", "lamp.kind=sun lamp.angular_diameter_deg=0", "render.soft_shadows", "no-size", true},
    {"rod", "lamp.reach=8 lamp.radius=0.3 lamp.intensity=0", "render.soft_shadows", "no-lamp", true},
    {"rod", "lamp.reach=8 lamp.radius=0.3 tiles.diffuse=0 plastic.diffuse=0 plastic.specular=0 clear.specular=0",
     "render.soft_shadows", "nothing-lit", true},
    {"rod", "", "render.soft_shadows", "no-size", true},
    {"rod", "tiles.diffuse=0 plastic.diffuse=0 plastic.specular=0 clear.specular=0", "lamp.position", "lights-nothing",
     true},
    {"rod", "tiles.diffuse=0 plastic.diffuse=0 plastic.specular=0 clear.specular=0", "render.shadows", "nothing-lit",
     true},
    {"rod", "render.integrator=path render.paths=4", "render.samples", "path-box", true},
    {"rod", "render.integrator=path render.paths=4", "render.energy_compensation", "no-roughness", true},
    {"rod", "render.integrator=path render.paths=4 lamp.reach=8 lamp.radius=0.3", "render.shadows", "spheres", true},
    {"rod", "render.integrator=path render.paths=4 lamp.reach=8 lamp.radius=0.3", "vessel.specular", "sphere-highlight",
     true},
    {"rod", "render.depth=0 render.beyond=black", "rod.reflectivity", "depth-0", true},
    {"rod", "render.lighting=phong", "rod.reflectivity", "no-tree", true},
    {"rod", "render.lighting=lambert", "rod.specular", "lambert", true},
    {"rod", "clear.transparency=0", "render.weights", "no-clear", true},
    {"rod", "clear.transparency=0 rod.reflectivity=0.5", "render.polarisation", "no-clear", true},
    {"rod", "render.integrator=path render.paths=4 clear.transparency=0", "render.polarisation", "no-clear", true},
    {"rod", "clear.transparency=0", "background.ior", "no-clear", true},
    {"rod", "render.transmission=simple clear.transparency=0.9", "vessel.ior", "straight", true},
    {"rod", "render.transmission=simple clear.transparency=0.9", "vessel.medium", "straight", true},
    {"rod", "render.integrator=raycast", "vessel.ior", "not-bent", true},
    {"rod", "render.lighting=phong", "background.ior", "not-bent", true},
    {"rod", "render.lighting=phong", "render.weights", "no-tree", true},
    {"rod", "render.integrator=raycast", "render.transmission", "no-tree", true},
    {"rod", "render.integrator=raycast render.shadows=off", "vessel.absorb_per_m", "no-tree", true},
    {"rod", "render.integrator=raycast render.shadows=off", "liquid.color", "no-tree", true},
    {"rod", "render.integrator=raycast render.shadows=off", "vessel.reflectivity", "no-tree", true},
    {"rod", "clear.ior=1 liquid.ior=1", "vessel.diffuse", "no-interface", true},
    {"rod", "clear.ior=1 liquid.ior=1", "liquid.ambient", "no-interface", true},
    {"rod", "render.integrator=zbuffer", "render.lambda_nm", "no-dispersion", true},
    {"models", "render.integrator=zbuffer paving.texture= banded.texture=", "render.texturing", "untextured", true},
    {"rod", "clear.transparency=0", "render.radiance", "no-dense", true},
    {"rod", "rod.visible=off", "plastic.color", "unused-material", true},
    {"rod", "rod.color=0,0,0", "rod.ambient", "black", true},
    {"rod", "rod.color=0,0,0", "rod.emission", "black", true},
    {"rod", "vessel.ior=1e9", "vessel.absorb_per_m", "mirror", true},
    {"rod", "rod.checker_color=0.85,0.15,0.1", "rod.checker", "one-color", true},
    {"rod", "rod.position=0,50,0 rod.priority=0", "rod.color", "unseen", false},
    {"rod", "rod.position=0,50,0 rod.priority=0", "rod.priority", "apart", false},
    {"rod",
     "background.horizon=0.53,0.75,0.92 background.color=0.53,0.75,0.92 background.rain=0 "
     "background.sky_type=5",
     "background.kind", "flat-gradient", true},
    {"rod", "", "camera.focus", "one-ray", true},
    {"rod", "", "camera.aperture", "one-ray", true},
    {"rod", "render.integrator=path render.paths=1", "camera.aperture", "one-ray", true},
    {"rod", "render.integrator=zbuffer render.samples=4", "camera.aperture", "chief-rays", true},
    {"rod", "render.integrator=aov", "camera.focus", "chief-rays", true},
    {"rod", "", "camera.analyser", "unpolarised", true},
    {"rod", "render.integrator=path render.paths=4", "camera.analyser", "unpolarised", true},
    {"rod", "render.weights=constant clear.transparency=0.9", "camera.analyser", "unpolarised", true},
    {"rod", "render.transmission=simple clear.transparency=0.9", "camera.analyser", "unpolarised", true},
    {"rod", "background.kind=rain background.rain=0", "background.sun_elevation_deg", "no-rain", true},
    {"rod", "background.kind=cie background.sky_type=3", "background.sun_elevation_deg", "even-sky", true},
    {"rod", "background.kind=cie lamp.kind=sun", "background.sun_elevation_deg", "sun-is-light", true},
    {"rod", "background.kind=cie lamp.kind=sun", "background.sun_azimuth_deg", "sun-is-light", true},
    {"slime", "toy.script= toy.time_s=0", "toy.stiffness", "time-0", true},
    {"slime", "floor.texture=", "tiles.filter", "unused-texture", true},
    {"models", "ring.visible=off", "torus.around", "unused-mesh", true},
    {"rod", "liquid.film_thickness_nm=300 render.weights=constant", "liquid.film_thickness_nm", "constant", true},
    {"rod", "liquid.ior=1e5 liquid.film_thickness_nm=300", "liquid.film_thickness_nm", "mirror", true},
    {"rod", "render.integrator=path render.paths=4", "rod.roughness", "matte", true},
    {"rod", "render.integrator=path render.paths=4 render.weights=constant vessel.transparency=0.9", "vessel.roughness",
     "constant", true},
    {"rod", "rod.medium=gold", "rod.reflectivity", "layered", true},
    {"rod", "rod.film_thickness_nm=300", "rod.reflectivity", "layered", true},
    {"rod", "rod.medium=gold render.lighting=phong", "rod.medium", "no-tree", true},
    {"rod", "liquid.ior=1e5", "liquid.extraordinary_ior", "mirror", true},
    {"rod", "", "rod.sheet", "opaque", true},
    {"rod", "liquid.ior=1e5", "liquid.sheet", "mirror", true},
    {"rod", "render.lighting=phong render.shadows=off", "liquid.sheet", "no-tree", true},
    {"rod", "liquid.sheet=retarder", "liquid.retardance_deg", "unpolarised", true},
    {"rod", "", "lamp.polarised", "unpolarised", true},
    {"magnifier", "render.caustics=photons sun.lights=on sun.lambda_nm=1064", "sun.power", "unseen-beam", true},
    {"magnifier", "render.caustics=photons sun.lights=on sun.width=0", "sun.profile", "thin-beam", true},
    {"rod", "render.polarisation=on lamp.polarised=1", "lamp.polarisation_deg", "depolarised", true},
    {"rod", "render.integrator=path render.paths=4 liquid.sheet=retarder", "liquid.retardance_deg", "unpolarised",
     true},
    {"rod", "liquid.sheet=polariser", "liquid.sheet_axis", "unpolarised", true},
    {"rod", "render.polarisation=on liquid.sheet=retarder", "liquid.sheet_axis", "no-retardance", true},
    {"rod", "render.polarisation=on liquid.sheet=polariser liquid.sheet_block=1", "liquid.sheet_axis", "grey", true},
    {"models", "lamp.intensity=0 bowl.ambient=0 china.reflectivity=0", "bowl.shading", "unshaded", true},
};

/* Cases where the condition of a remedy without an assignment is false: there is no note, and the parameter changes the
 * film. */
typedef struct counterpart {
    const char *rule, *scene, *path, *assignments;
} counterpart;
static const counterpart counterparts[] = {
    {"no-textures", "models", "bowl.texture", ""},
    {"no-texture", "slime", "floor.texture_size", ""},
    {"mesh-texture", "slime", "paving.texture_size", ""},
    {"one-mesh", "models", "ring.mesh", ""},
    {"apart", "rod", "liquid.priority", ""},
    {"beam-lights-nothing", "magnifier", "sun.power", "render.caustics=photons sun.lights=on sun.target=0,-0.4,1.2"},
    {"depolarised-here", "rod", "lamp.polarised",
     "render.polarisation=on render.caustics=photons render.photons=20000"},
    {"one-light", "shapes", "render.light_sampling", "render.integrator=path render.paths=4"},
    {"unseen", "rod", "rod.color", ""},
    {"unseen", "rod", "rod.ambient", ""},
    {"unseen", "rod", "rod.diffuse", ""},
    {"unseen", "rod", "rod.emission", ""},
    {"unseen-highlight", "rod", "rod.specular", ""},
    {"by-face", "rod", "rod.color", ""},
    {"by-face", "rod", "rod.diffuse", ""},
    {"by-face", "rod", "rod.specular", ""},
    {"by-face", "rod", "rod.shininess", ""},
    {"by-face", "slime", "floor.texture", ""},
    {"by-face", "slime", "floor.texture_size", ""},
    {"of-solid", "rod", "vessel.ior", ""},
    {"of-solid", "rod", "vessel.medium", ""},
    {"of-solid", "rod", "vessel.coefficients", "vessel.coefficients=1.5,0.004 vessel.medium=cauchy"},
    {"of-solid", "rod", "rod.extinction", ""},
    {"of-solid", "rod", "vessel.film_thickness_nm", ""},
    {"of-solid", "rod", "vessel.roughness", "render.integrator=path render.paths=4"},
    {"of-solid", "rod", "vessel.film_ior", "vessel.film_thickness_nm=300"},
    {"of-solid", "rod", "vessel.extraordinary_ior", ""},
    {"of-solid", "rod", "vessel.optic_axis", "vessel.extraordinary_ior=1.7"},
    {"of-solid", "rod", "vessel.sheet", ""},
    {"of-solid", "rod", "vessel.sheet_axis", "render.polarisation=on vessel.sheet=polariser"},
    {"of-solid", "rod", "vessel.sheet_pass", "vessel.sheet=polariser"},
    {"of-solid", "rod", "vessel.sheet_block", "vessel.sheet=polariser"},
    {"of-solid", "rod", "vessel.retardance_deg", "render.polarisation=on vessel.sheet=retarder"},
    {"of-solid", "rod", "vessel.birefringence", "render.polarisation=on vessel.sheet=retarder"},
    {"of-solid", "rod", "vessel.absorb_per_m", ""},
    {"of-solid", "rod", "vessel.absorb_spectrum", ""},
    {"of-solid", "rod", "vessel.scatter_per_m", "render.integrator=path render.paths=4"},
    {"of-solid", "rod", "vessel.asymmetry", "render.integrator=path render.paths=4 vessel.scatter_per_m=2"},
    {"of-solid", "rod", "liquid.tint_distance", "liquid.color=0.9,0.7,0.5"},
    {"of-solid", "rod", "vessel.transparency", ""},
};

static bool open_with(const char *name, const char *assignments, acts *out, diagnostic *why)
{
    char path[200];
    snprintf(path, sizeof path, "experiments/scenes/%s.yaml", name);
    acts whole;
    if (!acts_open(path, &whole, why))
        return false;
    scene *s = scene_clone(whole.s);
    acts_close(&whole);
    if (s && acts_resize(s, 120) && acts_set_all(s, assignments, why))
        return acts_of(s, out, why);
    scene_destroy(s);
    return false;
}

/* Allocates the values of a parameter of the scene. */
static const param *values_at(const acts *a, const char *path, acts_values *v)
{
    param_place at;
    char *now = NULL;
    if (param_place_find(a->s, path, &at, NULL) != STATUS_OK || scene_get(a->s, path, &now, NULL) != STATUS_OK)
        return NULL;
    acts_values_of(a->s, at.row, now, v);
    free(now);
    return at.row;
}

static void try_condition(int number, account *out)
{
    const condition *k = &conditions[number];
    acts a;
    diagnostic why = {.what = ""};
    acts_values v;
    inert_answer answer;
    out->path = k->scene;
    if (!open_with(k->scene, k->assignments, &a, &why)) {
        complain(out, k->assignments, "cannot be rendered", why.what);
        return;
    }
    const param *row = values_at(&a, k->path, &v);
    if (!row || !acts_ask(&a, k->path, &answer) || strcmp(answer.rule, k->rule) != 0)
        complain(out, k->path, "the note that is expected is not said", k->rule);
    else {
        rule_count *rule = count_of(out, k->rule, row->name);
        const bool helped = k->works && remedy_works(&a, k->path, row, &answer);
        rule->reported++;
        if (helped)
            prove(rule);
        snprintf(rule->where, sizeof rule->where, "%s %s, %s", k->scene, k->assignments, k->path);
        drop_special_indices(&answer, row, &v);
        if (acts_try(&a, k->path, &v, 0, 1).changed > 0)
            complain(out, k->path, "acts, and yet a note says that it does not", answer.note.text);
        if (k->works && !helped)
            complain(out, k->path, "the note's remedy does not help", answer.note.remedy);
    }
    acts_close(&a);
}

static void try_counterpart(int number, account *out)
{
    const counterpart *k = &counterparts[number];
    acts a;
    diagnostic why = {.what = ""};
    acts_values v;
    inert_answer answer;
    out->path = k->scene;
    if (!open_with(k->scene, k->assignments, &a, &why)) {
        complain(out, k->path, "cannot be rendered", why.what);
        return;
    }
    const param *row = values_at(&a, k->path, &v);
    if (!row || acts_ask(&a, k->path, &answer) || acts_try_sizes(&a, k->path, &v, 1).changed == 0)
        complain(out, k->path, "is to act without a note, where the condition is false", k->rule);
    else {
        rule_count *rule = count_of(out, k->rule, row->name);
        prove(rule);
        snprintf(rule->where, sizeof rule->where, "%s %s", k->scene, k->path);
    }
    acts_close(&a);
}

static void add_rules(const account *one)
{
    for (int i = 0; i < one->rule_count; i++) {
        rule_count *r = count_of(&all, one->rules[i].rule, one->rules[i].name);
        r->reported += one->rules[i].reported;
        r->proved += one->rules[i].proved;
        if (one->rules[i].proved && !r->where[0])
            memcpy(r->where, one->rules[i].where, sizeof r->where);
    }
}

static void add_account(const account *one)
{
    if (one->tried == 0 && one->bad == 0) /* not selected */
        return;
    printf("# %-38s tried %4d, acting %3d, noted %3d, refused %d, marked %2d, unexplained or wrong %d\n", one->path,
           one->tried, one->acting, one->noted, one->refused, one->marked, one->bad);
    printf("%s", one->text);
    all.tried += one->tried, all.acting += one->acting, all.by_one += one->by_one, all.noted += one->noted;
    all.refused += one->refused, all.marked += one->marked, all.bad += one->bad;
    add_rules(one);
}

static void every_parameter_of_every_shipped_scene_changes_the_film_or_has_a_note(void **state)
{
    (void)state;
    assert_int_equal(glob("experiments/scenes/*.yaml", 0, NULL, &shipped), 0);
    assert_int_equal(glob("tests/data/acts/*.yaml", GLOB_APPEND, NULL, &shipped), 0);
    const int count = (int)shipped.gl_pathc;
    run(try_scene, count);
    for (int i = 0; i < count; i++)
        add_account(&accounts[i]);
    printf("# all: tried %d, acting %d (%d by one value alone), noted %d, refused with a remedy %d, marked %d, "
           "unexplained: %d\n",
           all.tried, all.acting, all.by_one, all.noted, all.refused, all.marked, all.bad);
    globfree(&shipped);
    assert_int_equal(all.bad, 0);
}

static void every_parameter_changes_the_film_or_has_a_note_in_every_render_mode(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    const int count = sizeof modes / sizeof *modes;
    int bad = 0;
    run(try_mode, count);
    for (int i = 0; i < count; i++) {
        const account *x = &accounts[i];
        printf("# rod, %s: tried %d, acting %d (%d by one value alone), noted %d, unexplained: %d\n%s", x->path,
               x->tried, x->acting, x->by_one, x->noted, x->bad, x->text);
        add_rules(x);
        bad += x->bad;
    }
    assert_int_equal(bad, 0);
}

static void add_jobs(job *one, int count)
{
    int bad = 0;
    run(one, count);
    for (int i = 0; i < count; i++) {
        printf("%s", accounts[i].text);
        add_rules(&accounts[i]);
        bad += accounts[i].bad;
    }
    assert_int_equal(bad, 0);
}

/* --- conditions on another parameter: each row of lint/needs.c --- */

#define SIZED "render.integrator=path render.paths=4 lamp.reach=8 lamp.radius=0.3"
static const struct {
    const char *scene, *assignments;
} homes[] = {
    {"rod", "render.photons=2000"},
    {"rod", SIZED},
    {"rod", "render.samples=4 background.picture=models.jpg background.kind=rain"},
    {"rod", "render.polarisation=on lamp.polarised=1 render.caustics=photons render.photons=2000"},
    {"shapes", "render.integrator=path render.paths=4"},
    {"magnifier", "render.caustics=photons render.photons=2000 sun.lights=on"},
    {"models", ""},
    {"slime", ""},
    {"slime", "toy.script= toy.ground=off"},
    {"rainbow-landscape", ""},
    {"meniscus", ""},
};

/* The path of the parameter that the row needs, for an object of that name; returns where its sign is. */
static const char *needed_path(const needs_row *r, const char *object, char path[NOTE_PLACE_MAX])
{
    const size_t length = strcspn(r->needs, "=!>");
    const bool full = memchr(r->needs, '.', length) != NULL;
    snprintf(path, NOTE_PLACE_MAX, "%s%s%.*s", full ? "" : object, full ? "" : ".", (int)length, r->needs);
    return r->needs + length;
}

/* Values with which the need is not met. */
static void unmet_values(const needs_row *r, const char *sign, const param *row, acts_values *v)
{
    static const char *const others[] = {"0.5", "400,0.1,700,0.5", "1,-0.2,0"};
    char text[80];
    v->count = 0;
    if (*sign != '=') {
        const char *value = sign + 1 + (*sign == '!');
        snprintf(text, sizeof text, "%.*s", (int)strcspn(value, "|"), value);
        acts_add(v, "", text);
        return;
    }
    for (size_t i = 0; row->choices && row->choices[i]; i++)
        if (!strstr(r->needs, row->choices[i]))
            acts_add(v, "", row->choices[i]);
    for (size_t i = 0; !row->choices && i < 3; i++)
        acts_add(v, "", others[i]);
}

/* Follows the remedies of other notes until the row's note is said. */
static bool is_said(scene *s, const char *path, const needs_row *r, inert_answer *answer)
{
    for (int i = 0; i < 5 && inert_ask(s, path, NULL, answer); i++) {
        if (strcmp(answer->rule, r->needs) == 0)
            return true;
        if (!acts_set_all(s, answer->note.remedy, NULL))
            return false;
    }
    return false;
}

/* Whether the film shows that the row is right where that assignment does not meet it. A false note is a complaint. */
static bool proves(const scene *home, const char *path, const needs_row *r, const char *assignment, account *out)
{
    acts a = {.s = NULL};
    inert_answer answer;
    acts_values v;
    scene *s = scene_clone(home);
    if (!acts_set_all(s, assignment, NULL) || !is_said(s, path, r, &answer)) {
        scene_destroy(s);
        return false;
    }
    if (!acts_of(s, &a, NULL))
        return false;
    const param *row = values_at(&a, path, &v);
    bool proved = row && remedy_works(&a, path, row, &answer);
    if (proved && acts_try(&a, path, &v, 0, 1).changed > 0) {
        complain(out, path, "acts, and yet a note says that it does not", answer.note.text);
        proved = false;
    }
    acts_close(&a);
    return proved;
}

static bool home_proves(const scene *home, const needs_row *r, const char *name, account *out)
{
    for (size_t i = 0; i < param_place_group_size(home, r->group); i++) {
        const char *object = param_place_group_name(home, r->group, i);
        char path[NOTE_PLACE_MAX], needed[NOTE_PLACE_MAX], assignment[NOTE_TEXT_MAX];
        param_place at, needed_at;
        acts_values v;
        snprintf(path, sizeof path, "%s.%s", object, name);
        const char *sign = needed_path(r, object, needed);
        if (param_place_find(home, path, &at, NULL) != STATUS_OK ||
            param_place_find(home, needed, &needed_at, NULL) != STATUS_OK)
            continue;
        const param *row = at.row;
        unmet_values(r, sign, needed_at.row, &v);
        for (int k = 0; k < v.count; k++) {
            snprintf(assignment, sizeof assignment, "%s=%.100s", needed, v.text[k]);
            if (proves(home, path, r, assignment, out)) {
                rule_count *rule = count_of(out, r->needs, row->name);
                prove(rule);
                snprintf(rule->where, sizeof rule->where, "%.100s, %.100s", path, assignment);
                return true;
            }
        }
    }
    return false;
}

static void try_need(const needs_row *r, const char *name, account *out)
{
    for (size_t h = 0; h < sizeof homes / sizeof *homes; h++) {
        acts home;
        if (!open_with(homes[h].scene, homes[h].assignments, &home, NULL))
            continue;
        const bool proved = home_proves(home.s, r, name, out);
        acts_close(&home);
        if (proved)
            return;
    }
    complain(out, name, "no scene shows that it has an effect only if", r->needs);
}

static void try_row(int number, account *out)
{
    size_t count;
    const needs_row *r = &needs_rows(&count)[number];
    char names[300], *rest = names;
    if (!r->needs)
        return;
    out->path = param_group_name(r->group);
    snprintf(names, sizeof names, "%s", r->names[0] == '*' ? "position" : r->names);
    for (char *name; (name = strtok_r(rest, " ", &rest));)
        try_need(r, name, out);
}

static void every_condition_of_the_table_decides(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    size_t count;
    needs_rows(&count);
    add_jobs(try_row, (int)count);
}

static void remedies_of_rare_notes_make_their_parameters_effective(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    add_jobs(try_condition, sizeof conditions / sizeof *conditions);
    add_jobs(try_counterpart, sizeof counterparts / sizeof *counterparts);
}

/* The notes of slices, a line each: rule, name, how often reported and proved. */
static void write_notes(FILE *file)
{
    for (int i = 0; i < all.rule_count; i++)
        fprintf(file, "%s %s %d %d\n", all.rules[i].rule, all.rules[i].name, all.rules[i].reported,
                all.rules[i].proved);
}

static void add_notes(FILE *file)
{
    static char words[2 * RULES_MAX][80]; /* the accounts keep pointers */
    int reported, proved;
    for (int i = 0; fscanf(file, "%79s %79s %d %d", words[2 * i], words[2 * i + 1], &reported, &proved) == 4;) {
        const int before = all.rule_count;
        rule_count *r = count_of(&all, words[2 * i], words[2 * i + 1]);
        r->reported += reported, r->proved += proved;
        i += all.rule_count > before;
        assert_true(i < RULES_MAX);
    }
    assert_true(all.rule_count > 0);
}

static void visit_notes(const char *mode, void (*visit)(FILE *))
{
    FILE *file = fopen(getenv("ACTS_NOTES"), mode);
    assert_non_null(file);
    visit(file);
    assert_int_equal(fclose(file), 0);
}

/* Of the cases before, or of the slices that have run. */
static void the_remedy_of_each_note_was_seen_to_make_a_parameter_effective(void **state)
{
    (void)state;
    if (slice.of > 1 && getenv("ACTS_NOTES"))
        visit_notes("w", write_notes);
    else if (slice.of == 0)
        visit_notes("r", add_notes);
    if (getenv("ACTS_SCENE") || slice.of > 1)
        skip();
    int unproved = 0;
    for (int i = 0; i < all.rule_count; i++) {
        const rule_count *r = &all.rules[i];
        printf("# %-16s %-16s said %3d, proved in %s\n", r->rule, r->name, r->reported, r->where);
        if (r->proved == 0)
            printf("# %s of %s is not proved: give it a remedy that is an assignment, or add it to the counterparts\n",
                   r->rule, r->name);
        unproved += r->proved == 0;
    }
    assert_int_equal(unproved, 0);
}

/* --- other settings: every parameter that has a note under them is without effect --- */

static const struct {
    const char *scene, *assignments;
} settings[] = {
    {"rod", "render.integrator=path render.paths=2"},
    {"rod", "render.integrator=path render.paths=2 lamp.reach=8 lamp.radius=0.3"},
    {"rod", "render.integrator=path render.paths=2 render.polarisation=on liquid.sheet=retarder"},
    {"rod", "render.integrator=raycast"},
    {"rod", "render.integrator=zbuffer"},
    {"rod", "render.integrator=zbuffer render.lighting=phong"},
    {"rod", "render.integrator=raycast render.shadows=off"},
    {"rod", "render.lighting=phong"},
    {"rod-from-inside", "render.lighting=phong render.shadows=off"},
    {"rod", "clear.ior=1 liquid.ior=1"},
    {"absorber", "liquid.ior=1 liquid.color=0.5,0.5,0.5"},
    {"rod", "render.spectrum=spectral render.wavelengths=4"},
    {"rod", "render.weights=constant clear.transparency=0.8 clear.reflectivity=0.1"},
    {"rod", "render.transmission=simple clear.transparency=0.8 clear.reflectivity=0.1"},
    {"rod", "render.polarisation=on vessel.medium=bk7"},
    {"rod", "render.depth=0 render.beyond=black"},
    {"rod", "render.lighting=lambert vessel.ior=1e9"},
    {"rod", "render.shadows=off rod.checker=0.2 rod.priority=0"},
    {"rod", "lamp.intensity=0 background.ambient=0,0,0 clear.color=0.9,0.8,0.7"},
    {"solids", "render.integrator=zbuffer key.kind=cone"},
    {"solids", "render.integrator=path render.paths=1 render.roulette=on glass.diffuse=0.2"},
    {"solids", "background.picture=models.jpg clay.transparency=0.3"},
    {"models", "render.integrator=zbuffer render.texturing=affine"},
    {"models", "render.integrator=path render.paths=1 silver.texture=tiles"},
    {"models", "bowl.visible=off lamp.intensity=0 render.shadows=opaque"},
    {"vessel-mesh", "render.weights=constant clear.transparency=0.5 render.integrator=raycast"},
    {"slime", "toy.script= toy.time_s=0 toy.ground=off"},
    {"solids", "glass.emission=0.2 steel.color=0,0,0 background.ambient=0,0,0 key.intensity=0 fill.intensity=0"},
};

typedef struct truth {
    acts *a;
    account *out;
} truth;

static status try_note(void *context, const char *path, const param *row, const char *value)
{
    truth *x = context;
    acts_values v;
    inert_answer answer;
    char line[NOTE_LINE_MAX];
    if (!inert_ask(x->a->s, path, NULL, &answer))
        return STATUS_OK;
    acts_values_of(x->a->s, row, value, &v);
    drop_special_indices(&answer, row, &v);
    v.count = v.count < 4 ? v.count : 4;
    x->out->noted++;
    if (acts_try(x->a, path, &v, 0, 1).changed > 0)
        complain(x->out, path, "acts, and yet a note says that it does not",
                 note_line(&answer.note, line, sizeof line));
    return STATUS_OK;
}

static void try_setting(int number, account *out)
{
    acts a;
    diagnostic why = {.what = ""};
    out->path = settings[number].assignments;
    if (!open_with(settings[number].scene, settings[number].assignments, &a, &why)) {
        complain(out, settings[number].scene, "cannot be rendered", why.what);
        return;
    }
    scene_each_param(a.s, try_note, &(truth){&a, out});
    acts_close(&a);
}

static void parameters_with_a_note_have_no_effect_under_other_settings(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    const int count = sizeof settings / sizeof *settings;
    int noted = 0, bad = 0;
    run(try_setting, count);
    for (int i = 0; i < count; i++) {
        printf("%s", accounts[i].text);
        noted += accounts[i].noted, bad += accounts[i].bad;
    }
    printf("# other settings: %d notes, %d false\n", noted, bad);
    assert_int_equal(bad, 0);
}

int main(void)
{
    read_slice();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_condition_of_the_table_decides),
        cmocka_unit_test(remedies_of_rare_notes_make_their_parameters_effective),
        cmocka_unit_test(every_parameter_of_every_shipped_scene_changes_the_film_or_has_a_note),
        cmocka_unit_test(every_parameter_changes_the_film_or_has_a_note_in_every_render_mode),
        cmocka_unit_test(the_remedy_of_each_note_was_seen_to_make_a_parameter_effective),
        cmocka_unit_test(parameters_with_a_note_have_no_effect_under_other_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
