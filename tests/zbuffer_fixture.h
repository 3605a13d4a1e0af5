/* What the tests of the depth buffer share: a scene that is loaded, and a film that no order of the work may change.
 * Ownership: scene_loaded gives, one_film_only frees. */
#pragma once

#include "scene/model/scene.h"
#include "render_fixture.h"

static inline scene *scene_loaded(const char *text, const char *assignments)
{
    scene *s = scene_from(text);
    diagnostic why = {0};
    set_all(s, assignments);
    worked(scene_load(s, &why), &why);
    return s;
}

static inline uint64_t film_hash_at(const scene *s, isa level)
{
    render_result *r = render_at(s, level, NULL);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    return hash;
}

static inline void one_film_only(scene *s)
{
    static const char *const how[] = {"render.threads=2",
                                      "render.threads=7 render.schedule=columns",
                                      "render.threads=7 render.schedule=rows render.pool=off",
                                      "render.threads=2 render.schedule=tiles render.tile=8",
                                      "render.threads=1 render.schedule=tiles render.tile=1",
                                      "render.threads=64 render.schedule=dynamic render.tile=50",
                                      "render.keep=off render.accel=none"};
    for (int samples = 1; samples <= 4; samples += 3) {
        set(s, samples == 1 ? "render.samples=1" : "render.samples=4");
        const uint64_t wanted = film_hash_at(s, ISA_BASE);
        for (int level = ISA_BASE + 1; level <= (int)isa_best(); level++)
            assert_true(film_hash_at(s, (isa)level) == wanted);
        for (size_t h = 0; h < sizeof how / sizeof *how; h++) {
            set_all(s, how[h]);
            assert_true(film_hash_at(s, isa_best()) == wanted);
        }
    }
    scene_destroy(s);
}
