/* The reader of plain OBJ files (obj.h). */
#include "import/obj.h"
#include "base/array.h"
#include "base/file.h"
#include "base/os_process.h"
#include "base/thread_team.h"
#include "import/import.h"
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- parts of the file, parsed in parallel; the result does not depend on how the file is divided --- */

enum {
    PART_BYTES_MIN = 1 << 20, /* a smaller part is not worth a thread */
    FILE_BYTES_MIN = 16       /* assimp refuses smaller ones */
};

static const char *map_file(const request *req, size_t *size)
{
    struct stat about;
    const int fd = below_open(req->path, req->root);
    void *bytes = MAP_FAILED;
    if (fd >= 0 && fstat(fd, &about) == 0 && about.st_size >= FILE_BYTES_MIN)
        bytes = mmap(NULL, (size_t)about.st_size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, fd, 0);
    if (fd >= 0)
        close(fd);
    *size = bytes == MAP_FAILED ? 0 : (size_t)about.st_size;
    return bytes == MAP_FAILED ? NULL : bytes;
}

/* Divides the text into parts that end at line ends. False: the last line is too long. */
static bool divide(obj_file *f, const char *text, size_t size)
{
    const char *end = memrchr(text, '\n', size);
    end = end ? end + 1 : text;
    const size_t rest = size - (size_t)(end - text);
    if (rest > OBJ_LINE_MAX)
        return false;
    const int units = os_usable_units();
    size_t count = units < 1 ? 1 : units > OBJ_THREADS_MAX ? OBJ_THREADS_MAX : (size_t)units;
    if (count > size / PART_BYTES_MIN)
        count = size / PART_BYTES_MIN + 1;
    for (const char *at = text; at < end;) {
        const size_t left = (size_t)(end - at), part = left / (count - (size_t)f->part_count);
        const char *line_end = memchr(at + part - 1, '\n', left - part + 1);
        f->parts[f->part_count++] = (obj_part){.begin = at, .end = line_end + 1};
        at = line_end + 1;
    }
    if (rest > 0) {
        memcpy(f->last_line, end, rest);
        f->last_line[rest] = '\n';
        f->parts[f->part_count++] = (obj_part){.begin = f->last_line, .end = f->last_line + rest + 1};
    }
    return true;
}

static void parse(void *parts, size_t index, int member)
{
    (void)member;
    obj_parse((obj_part *)parts + index);
}

/* Parses all parts; false: a part is not plain. */
static bool parse_all(obj_file *f)
{
    thread_team *team = thread_team_create(f->part_count);
    if (!team)
        return false;
    thread_team_run(team, parse, f->parts, (size_t)f->part_count);
    thread_team_destroy(team);
    bool plain = true;
    size_t uvs = 0;
    for (int i = 0; i < f->part_count; i++) {
        /* While a file has normals but no texture coordinates yet, assimp reads a face's texture indices as normals. */
        plain &= f->parts[i].plain && !(f->parts[i].early && uvs == 0);
        uvs += f->parts[i].uv_count;
        f->triangle_count += f->parts[i].triangle_count;
    }
    return plain && f->triangle_count > 0;
}

static void copy(void *to, const void *from, size_t bytes)
{
    if (bytes)
        memcpy(to, from, bytes);
}

/* Appends the vertices, texture coordinates and normals of all parts to the first part's. */
static bool merge_parts(obj_file *f)
{
    obj_part *all = &f->parts[0];
    for (int i = 1; i < f->part_count; i++) {
        const obj_part *o = &f->parts[i];
        if (!GROW(all->places, all->place_room, all->place_count + o->place_count) ||
            !GROW(all->uvs, all->uv_room, all->uv_count + o->uv_count) ||
            !GROW(all->normals, all->normal_room, all->normal_count + o->normal_count))
            return false;
        copy(all->places + all->place_count, o->places, o->place_count * sizeof *o->places);
        copy(all->uvs + all->uv_count, o->uvs, o->uv_count * sizeof *o->uvs);
        copy(all->normals + all->normal_count, o->normals, o->normal_count * sizeof *o->normals);
        all->place_count += o->place_count;
        all->uv_count += o->uv_count;
        all->normal_count += o->normal_count;
    }
    return true;
}

/* Whether all indices exist. */
static bool indices_exist(const obj_file *f)
{
    const obj_part *all = &f->parts[0];
    for (int i = 0; i < f->part_count; i++) {
        const obj_corner h = f->parts[i].highest;
        if (h.place > all->place_count || h.uv > all->uv_count || h.normal > all->normal_count)
            return false;
    }
    return true;
}

static bool load_text(const request *req, obj_file *f, const char *text, size_t size)
{
    return divide(f, text, size) && parse_all(f) && f->triangle_count <= req->triangles && merge_parts(f) &&
           indices_exist(f);
}

/* Parses the file. False: it is not plain, or memory ran out; the caller frees what was allocated. */
static bool load(const request *req, obj_file *f)
{
    size_t size;
    const char *text = map_file(req, &size);
    const bool plain = text && load_text(req, f, text, size);
    if (text)
        munmap((void *)(uintptr_t)text, size);
    return plain;
}

/* --- the triangles in the order of assimp, with joined vertices ---
 *
 * Puts the triangles of a plain OBJ file into the order in which assimp returns them, and joins their vertices. To find
 * the order, the materials and the meaning of groups, assimp reads a text with the same statements but only one
 * triangle per run of faces; the x of its vertex is the run's number. */

enum {
    RUNS_MAX = 1 << 24, /* a float represents the number of each run exactly */
    AHEAD = 64          /* corners whose table entries are prefetched together */
};

/* A run of faces in the whole file. */
typedef struct run {
    obj_corner (*triangles)[3];
    size_t count;
} run;

/* The last vertex that was joined at a position; index_plus_1 is 0 if there is none. */
typedef struct last_vertex {
    uint32_t uv, normal, index_plus_1;
} last_vertex;

typedef struct assembly {
    const request *req;
    flat_mesh *flat;
    float (*places)[3], (*uvs)[2], (*normals)[3];
    last_vertex *last;
    joiner join;
} assembly;

/* ---- order and materials ---- */

static void write_text(const obj_part *o, size_t from, size_t to, FILE *stream)
{
    if (to > from)
        fwrite(o->text + from, 1, to - from, stream);
}

/* Lists the runs, and writes the text for assimp. */
static bool list_runs(const obj_file *f, run **runs, char **text, size_t *length)
{
    size_t count = 0;
    for (int i = 0; i < f->part_count; i++)
        count += f->parts[i].run_count;
    FILE *to = count <= RUNS_MAX ? open_memstream(text, length) : NULL;
    *runs = malloc(count * sizeof **runs);
    if (!to || !*runs)
        return false;
    fprintf(to, "# the order of faces\n");
    count = 0;
    for (int i = 0; i < f->part_count; i++) {
        const obj_part *o = &f->parts[i];
        size_t done = 0;
        for (size_t r = 0; r < o->run_count; r++) {
            write_text(o, done, o->runs[r].text_end, to);
            done = o->runs[r].text_end;
            (*runs)[count] = (run){o->triangles + o->runs[r].first, o->runs[r].count};
            fprintf(to, "v %zu 0 0\n", count);
            count++;
            fprintf(to, "f %zu %zu %zu\n", count, count, count);
        }
        write_text(o, done, o->text_length, to);
    }
    return fclose(to) == 0;
}

/* ---- vertices ---- */

static void numbers_of(const assembly *a, obj_corner c, double numbers[8])
{
    memset(numbers, 0, 8 * sizeof *numbers);
    for (int k = 0; k < 3; k++) /* + 0.0: -0 becomes 0 */
        numbers[k] = (double)a->places[c.place - 1][k] + 0.0;
    for (int k = 0; c.normal && k < 3; k++)
        numbers[3 + k] = (double)a->normals[c.normal - 1][k] + 0.0;
    for (int k = 0; c.uv && k < 2; k++)
        numbers[6 + k] = (double)a->uvs[c.uv - 1][k] + 0.0;
}

static bool is_last(const last_vertex *v, obj_corner c)
{
    return v->index_plus_1 && v->uv == c.uv && v->normal == c.normal;
}

/* Sets the vertices of up to AHEAD corners. False: out of memory, or too many vertices. */
static bool join_corners(assembly *a, const obj_corner *corners, size_t count, uint32_t *indices)
{
    double numbers[AHEAD][8];
    uint64_t hashes[AHEAD];
    bool ready[AHEAD];
    for (size_t i = 0; i < count; i++) {
        ready[i] = !is_last(&a->last[corners[i].place - 1], corners[i]);
        if (!ready[i])
            continue;
        numbers_of(a, corners[i], numbers[i]);
        hashes[i] = join_hash(a->flat, numbers[i]);
        join_prefetch(&a->join, hashes[i]);
    }
    for (size_t i = 0; i < count; i++) {
        last_vertex *last = &a->last[corners[i].place - 1];
        if (!is_last(last, corners[i])) {
            if (!ready[i]) { /* an earlier corner of this block has replaced the last vertex */
                numbers_of(a, corners[i], numbers[i]);
                hashes[i] = join_hash(a->flat, numbers[i]);
            }
            if (join_vertex(&a->join, a->flat, a->req->vertices, numbers[i], hashes[i], &indices[i]) != JOINED)
                return false;
            *last = (last_vertex){corners[i].uv, corners[i].normal, indices[i] + 1};
        }
        indices[i] = last->index_plus_1 - 1;
    }
    return true;
}

static bool append_run(assembly *a, const run *r, uint8_t slot)
{
    const obj_corner *corners = r->triangles[0];
    uint32_t *indices = a->flat->triangles[a->flat->triangle_count];
    memset(a->flat->slots + a->flat->triangle_count, slot, r->count);
    a->flat->triangle_count += r->count;
    for (size_t i = 0; i < 3 * r->count; i += AHEAD) {
        const size_t left = 3 * r->count - i;
        if (!join_corners(a, corners + i, left < AHEAD ? left : AHEAD, indices + i))
            return false;
    }
    return true;
}

/* Fills `flat` with the runs in the order of the triangles of `order`, one per run. */
static bool assemble(const request *req, const obj_file *f, const flat_mesh *order, const run *runs, flat_mesh *flat)
{
    const obj_part *all = &f->parts[0];
    for (int i = 0; i < f->part_count; i++) {
        flat->with_uvs |= f->parts[i].highest.uv > 0;
        flat->with_normals |= f->parts[i].highest.normal > 0;
    }
    flat->material_count = order->material_count;
    memcpy(flat->materials, order->materials, sizeof flat->materials);
    const size_t triangles = f->triangle_count * sizeof *flat->triangles;
    flat->triangles = large_pages(malloc(triangles), triangles);
    flat->slots = malloc(f->triangle_count);
    assembly a = {req, flat, all->places, all->uvs, all->normals, large_calloc(all->place_count, sizeof(last_vertex)),
                  {0}};
    bool good = flat->triangles && flat->slots && a.last && join_reserve(&a.join, flat, all->place_count);
    for (size_t t = 0; t < order->triangle_count && good; t++)
        good = append_run(&a, &runs[(size_t)order->positions[order->triangles[t][0]].x], order->slots[t]);
    free(a.last);
    free(a.join.table);
    return good;
}

static bool read_all(const request *req, obj_file *f, flat_mesh *flat, const struct aiScene **scene)
{
    run *runs = NULL;
    char *text = NULL;
    size_t length;
    flat_mesh order = {0};
    bool good = list_runs(f, &runs, &text, &length) && (*scene = read_scene_text(req, text, length)) &&
                flatten(req, *scene, &order, NULL) == STATUS_OK && assemble(req, f, &order, runs, flat);
    free(runs);
    free(text);
    return good;
}

bool obj_read(const request *req, flat_mesh *flat, const struct aiScene **scene)
{
    obj_file *f = calloc(1, sizeof *f);
    const bool good = f && load(req, f) && read_all(req, f, flat, scene);
    if (!good) { /* assimp needs the memory */
        free(flat->triangles), free(flat->slots), free(flat->positions), free(flat->normals), free(flat->uvs);
        *flat = (flat_mesh){0};
    }
    for (int i = 0; f && i < f->part_count; i++) {
        obj_part *o = &f->parts[i];
        free(o->places), free(o->uvs), free(o->normals), free(o->triangles), free(o->runs), free(o->text);
    }
    free(f);
    return good;
}
