/* The parts of an OBJ file, parsed in parallel, with the vertices of all. The parts do not alter the result. */
#include "import/obj.h"

#include "base/file.h"
#include "base/array.h"
#include "base/os_process.h"
#include "base/thread_team.h"
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* Divides the text into parts of whole lines. False: its last line is too long. */
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
        const size_t left = (size_t)(end - at), share = left / (count - (size_t)f->part_count);
        const char *line_end = memchr(at + share - 1, '\n', left - share + 1);
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

/* Parses all parts; false: they are not plain. */
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
        /* assimp takes the texture coordinates of a face for normals as long as there are only normals. */
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

/* Adds the vertices, texture coordinates and normals of all parts to those of the first one. */
static bool gather(obj_file *f)
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

/* Do all indices exist? */
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
    return divide(f, text, size) && parse_all(f) && f->triangle_count <= req->triangles && gather(f) &&
           indices_exist(f);
}

bool obj_load(const request *req, obj_file *f)
{
    size_t size;
    const char *text = map_file(req, &size);
    const bool plain = text && load_text(req, f, text, size);
    if (text)
        munmap((void *)(uintptr_t)text, size);
    return plain;
}
