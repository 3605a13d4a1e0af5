/* Writes and reads packages: their head and hash, packages in memory, and the hierarchies that they have. */
#include "scene/package/package.h"
#include "base/array.h"
#include "base/hash.h"
#include "base/installed.h"
#include "geometry/hierarchy/hierarchy.h"
#include "scene/file/write.h"
#include "scene/model/face_materials.h"
#include "scene/model/integrators.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

#define PACKAGE_MAGIC "CUVSCENE"
#define PACKAGE_ORDER 0x01020304u

typedef struct package_head {
    char magic[8];
    uint32_t order, version; /* PACKAGE_ORDER in the machine's byte order; PACKAGE_VERSION */
    uint64_t pointer_bytes;
    char build[24]; /* filled with zeros */
    uint64_t size;  /* of the package, with head and hash */
} package_head;
_Static_assert(sizeof(package_head) == 56, "no padding");

enum { PACKAGE_VERSION = 6 };

static package_head head_of(uint64_t size)
{
    package_head head = {.magic = PACKAGE_MAGIC,
                         .order = PACKAGE_ORDER,
                         .version = PACKAGE_VERSION,
                         .pointer_bytes = sizeof(void *),
                         .size = size};
    strncpy(head.build, build_id(), sizeof head.build - 1);
    return head;
}

static status check_head(const package_head *head, diagnostic *why)
{
    const package_head expected = head_of(head->size);
    if (memcmp(head->magic, expected.magic, sizeof expected.magic) != 0)
        return pack_damaged(why, "it does not begin as a package");
    if (head->order != expected.order || head->version != expected.version ||
        head->pointer_bytes != expected.pointer_bytes)
        return diagnose(why, STATUS_BAD_INPUT, "use machines of one kind, and the same build on each",
                        "the package of the scene comes from another kind of machine");
    if (memcmp(head->build, expected.build, sizeof expected.build) != 0)
        return diagnose(why, STATUS_BAD_INPUT, "use the same build of cuvette everywhere",
                        "the package of the scene comes from another build (%.*s, not %s)", (int)sizeof head->build - 1,
                        head->build, expected.build);
    return STATUS_OK;
}

static status put_all(pack_writer *to, uint64_t size, const scene *s, const char *text, diagnostic *why)
{
    const package_head head = head_of(size);
    TRY(pack_put(to, &head, sizeof head, why));
    TRY(package_put_scene(to, s, text, why));
    const uint64_t hash = hash_finish(to->hash);
    return pack_put(to, &hash, sizeof hash, why);
}

/* A scene and the size of its package. */
typedef struct counted_scene {
    const scene *s;
    char *text;
    uint64_t size;
} counted_scene;

/* Measures the package. The caller frees c->text. */
static status count(counted_scene *c, diagnostic *why)
{
    TRY(scene_write_text(c->s, c->s->path, false, &c->text, why));
    pack_writer counting = {.write = NULL};
    TRY(put_all(&counting, 0, c->s, c->text, why));
    c->size = counting.size;
    return STATUS_OK;
}

status scene_pack_to(const scene *s, pack_write *write, void *context, diagnostic *why)
{
    counted_scene c = {.s = s};
    pack_writer to = {.write = write, .context = context, .hash = HASH_START};
    status code = count(&c, why);
    THEN(code, put_all(&to, c.size, s, c.text, why));
    free(c.text);
    return code;
}

/* expected_size: the size that the package must have; 0: any. */
static status get_all(pack_reader *from, uint64_t expected_size, scene **out, diagnostic *why)
{
    package_head head;
    TRY(pack_get(from, &head, sizeof head, why));
    TRY(check_head(&head, why));
    if (head.size < sizeof head || (expected_size && head.size != expected_size))
        return pack_damaged(why, "it has the wrong size");
    from->left = head.size - sizeof head;
    TRY(package_get_scene(from, out, why));
    const uint64_t expected = hash_finish(from->hash);
    uint64_t hash;
    TRY(pack_get(from, &hash, sizeof hash, why));
    if (hash != expected)
        return pack_damaged(why, "its hash is wrong");
    return from->left == 0 ? STATUS_OK : pack_damaged(why, "it has the wrong size");
}

static status unpack(pack_read *read, void *context, uint64_t expected_size, scene **out, diagnostic *why)
{
    pack_reader from = {.read = read, .context = context, .left = sizeof(package_head), .hash = HASH_START};
    *out = NULL;
    const status code = get_all(&from, expected_size, out, why);
    if (code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}

status scene_unpack_from(pack_read *read, void *context, scene **out, diagnostic *why)
{
    return unpack(read, context, 0, out, why);
}

typedef struct memory {
    char *at;
    const char *from;
    size_t left;
} memory;

static status to_memory(void *context, const void *bytes, size_t size, diagnostic *why)
{
    memory *m = context;
    if (size > m->left)
        return diagnose(why, STATUS_FAILURE, NULL, "the scene changed while it was packed");
    memcpy(m->at, bytes, size);
    m->at += size;
    m->left -= size;
    return STATUS_OK;
}

status scene_pack(const scene *s, void **bytes, size_t *size, diagnostic *why)
{
    counted_scene c = {.s = s};
    *bytes = NULL;
    status code = count(&c, why);
    if (code == STATUS_OK && !(*bytes = large_pages(malloc(c.size), c.size)))
        code = out_of_memory(why);
    memory buffer = {.at = *bytes, .left = c.size};
    pack_writer to = {.write = to_memory, .context = &buffer, .hash = HASH_START};
    THEN(code, put_all(&to, c.size, s, c.text, why));
    free(c.text);
    if (code != STATUS_OK) {
        free(*bytes);
        *bytes = NULL;
    }
    *size = c.size;
    return code;
}

static status from_memory(void *context, void *bytes, size_t size, diagnostic *why)
{
    memory *m = context;
    if (size > m->left)
        return pack_damaged(why, "it ends early");
    memcpy(bytes, m->from, size);
    m->from += size;
    m->left -= size;
    return STATUS_OK;
}

status scene_unpack(const void *bytes, size_t size, scene **out, diagnostic *why)
{
    memory buffer = {.from = bytes, .left = size};
    return unpack(from_memory, &buffer, size ? size : 1, out, why);
}

/* Builds the hierarchies that the plan of a frame (render/plan/plan.c) uses. */
status scene_build_hierarchies(const scene *s, diagnostic *why)
{
    if (!s->render.keep || integrator_traits_of(&s->render)->drawn)
        return STATUS_OK;
    for (size_t i = 0; i < s->solid_count; i++) {
        const mesh_entry *m = s->solids[i].visible ? scene_mesh_of(s, &s->solids[i]) : NULL;
        const hierarchy *built;
        const mesh *const *operands;
        int count;
        if (m && m->data)
            TRY(scene_mesh_operands(s, &s->solids[i], &operands, &count, why));
        if (m && m->data && operands[0] == m->data) /* other operands are made from the mesh where it is used */
            TRY(hierarchy_of_mesh(m->data, (hierarchy_kind)s->render.accel, scene_build_threads(&s->render), &built,
                                  why));
    }
    return STATUS_OK;
}
