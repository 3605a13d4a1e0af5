/* Listings and copies of folders. */
#include "folder.h"

#include <ctype.h>
#include <dirent.h>
#include <err.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

char *file_text(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    size_t room = 65536, used = 0, got = 1;
    char *text = malloc(room);
    while (text && file && got > 0) {
        got = fread(text + used, 1, room - used - 1, file);
        used += got;
        if (used + 1 == room)
            text = realloc(text, room *= 2);
    }
    if (file)
        fclose(file);
    if (!text)
        err(3, "%s", path);
    text[used] = '\0';
    if (size)
        *size = used;
    return text;
}

void mask_numbers(char *text)
{
    char *to = text;
    for (const char *c = text; *c;) {
        if (!isdigit((unsigned char)*c)) {
            *to++ = *c++;
            continue;
        }
        while (isdigit((unsigned char)*c) || *c == '.' || (*c == 'e' && (c[1] == '-' || c[1] == '+')) ||
               ((*c == '-' || *c == '+') && c[-1] == 'e'))
            c++;
        *to++ = '#';
    }
    *to = '\0';
}

static uint64_t hash_bytes(const char *bytes, size_t size)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325); /* FNV-1a */
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ (unsigned char)bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

static listing *filling;
static size_t root_length;

static int add(const char *path, const struct stat *about, int kind, struct FTW *where)
{
    if (where->level == 0)
        return 0;
    filling->entries = realloc(filling->entries, (filling->count + 1) * sizeof *filling->entries);
    entry *e = &filling->entries[filling->count++];
    *e = (entry){.name = strdup(path + root_length + 1), .size = (long)about->st_size};
    if (kind != FTW_F)
        return 0;
    size_t size;
    char *text = file_text(path, &size);
    e->hash = hash_bytes(text, size);
    for (size_t i = 0; i < size; i++)
        e->lines += text[i] == '\n';
    mask_numbers(text);
    e->masked = hash_bytes(text, strlen(text));
    free(text);
    return 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const entry *)a)->name, ((const entry *)b)->name);
}

listing folder_list(const char *path)
{
    listing l = {.count = 0};
    filling = &l;
    root_length = strlen(path);
    nftw(path, add, 16, FTW_PHYS);
    if (l.count)
        qsort(l.entries, l.count, sizeof *l.entries, by_name);
    return l;
}

void listing_free(listing *l)
{
    for (size_t i = 0; i < l->count; i++)
        free(l->entries[i].name);
    free(l->entries);
    *l = (listing){.count = 0};
}

const entry *listing_find(const listing *l, const char *name)
{
    const entry key = {.name = (char *)name};
    return l->count ? bsearch(&key, l->entries, l->count, sizeof key, by_name) : NULL;
}

bool listing_same(const listing *a, const listing *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; same && i < a->count; i++)
        same = strcmp(a->entries[i].name, b->entries[i].name) == 0 && a->entries[i].hash == b->entries[i].hash;
    return same;
}

static int drop(const char *path, const struct stat *about, int kind, struct FTW *where)
{
    (void)about, (void)kind, (void)where;
    return remove(path);
}

void folder_remove(const char *path)
{
    nftw(path, drop, 16, FTW_PHYS | FTW_DEPTH);
}

static const char *copy_to;

static int copy(const char *path, const struct stat *about, int kind, struct FTW *where)
{
    (void)where;
    char target[4096];
    snprintf(target, sizeof target, "%s%s", copy_to, path + root_length);
    if (kind == FTW_D)
        return mkdir(target, 0777);
    size_t size;
    char *text = file_text(path, &size);
    const int fd = open(target, O_WRONLY | O_CREAT | O_TRUNC, about->st_mode & 0777);
    const bool written = fd >= 0 && write(fd, text, size) == (ssize_t)size;
    free(text);
    if (fd >= 0)
        close(fd);
    return written ? 0 : -1;
}

void folder_copy(const char *from, const char *to)
{
    folder_remove(to);
    copy_to = to;
    root_length = strlen(from);
    if (nftw(from, copy, 16, FTW_PHYS) != 0)
        err(3, "cannot copy %s to %s", from, to);
}
