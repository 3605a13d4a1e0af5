/* The statements of an OBJ file, parsed in parts that end at line ends: what obj.c joins. Ownership: obj_part_release
 * frees what obj_parse has allocated. */
#pragma once

#include "import/plain.h"

/* The indices of a corner: from 1; 0: none; negative: relative to the statements before (obj_relative). */
typedef struct obj_corner {
    int32_t place, uv, normal;
} obj_corner;

enum { OBJ_INDEX_MAX = 1 << 29, OBJ_RELATIVE = 1 << 30 };

/* The index from 1 of a corner, or a number out of range; `before`: statements of its kind before the part. */
static inline int64_t obj_index(int32_t index, size_t before)
{
    return index < 0 ? (int64_t)index + OBJ_RELATIVE + (int64_t)before : index;
}

/* A statement usemtl or mtllib before a face of the part; its names are in the text. */
typedef struct obj_event {
    size_t face, length;
    const char *names;
    uint32_t line;
    bool library;
} obj_event;

typedef struct obj_part {
    const char *begin, *end; /* ends with a line end */
    double (*places)[3], (*uvs)[2], (*normals)[3];
    double (*colors)[3]; /* of places, up to the last that has one; those without are white */
    obj_corner *corners;
    uint32_t *sizes; /* the number of corners of each face; NULL: three */
    obj_event *events;
    size_t place_count, uv_count, normal_count, color_count, corner_count, face_count, event_count;
    size_t place_room, uv_room, normal_room, color_room, corner_room, size_room, event_room;
    size_t until;  /* parsing stops after that many faces; 0: at the end */
    bool relative; /* there are relative indices */
    bool clear;    /* a vertex has an alpha below 1 */
    bool narrow;   /* a face had fewer than three corners, and was left out */
    obj_corner highest;
    uint32_t line;     /* lines so far */
    bool no_memory;    /* parsing stopped */
    const char *fault; /* the mistake in the last line, which may be at a word; NULL: none */
    const char *remedy, *word;
    size_t word_length;
} obj_part;

/* The number of corners of a face, at least 3. */
static inline uint32_t obj_size(const obj_part *part, size_t face)
{
    return part->sizes ? part->sizes[face] : 3;
}

/* Parses the lines of the part, to its end or its first mistake. */
void obj_parse(obj_part *part);
/* The line of the part, from 0, in which a face begins; parses once more. */
uint32_t obj_face_line(const obj_part *part, size_t face);
void obj_part_release(obj_part *part);
