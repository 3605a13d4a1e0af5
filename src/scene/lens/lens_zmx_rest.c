/* What a .zmx file holds besides the prescription (lens_reader.h): words that are kept for a writer, those of them that
 * act on light, words that are mistakes, and an image that is missing. */
#include "base/array.h"
#include "base/text.h"
#include "optics/media.h"
#include "scene/lens/lens_reader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COUNT(a) (sizeof(a) / sizeof *(a))

/* Those of lens_zmx.c. */
static const char *const read_words[] = {"TYPE", "CURV", "CONI", "PARM", "DISZ", "GLAS", "DIAM", "CLAP",
                                         "FLAP", "COMM", "STOP", "SURF", "UNIT", "MODE", "NAME", "ENPD",
                                         "FNUM", "OBNA", "FLOA", "FTYP", "XFLN", "XFLD", "YFLN", "YFLD",
                                         "WAVM", "WAVL", "PWAV", "VDXN", "VDYN", "VCXN", "VCYN"};
/* What a designer's program shows, solves, optimises and prints: nothing that acts on a ray. */
static const char *const quiet_words[] = {
    "VERS", "NOTE", "PFIL", "LANG", "ENVD", "GFAC", "GCAT", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD", "HYPR",
    "PICB", "FWGN", "FWGT", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "FIMP", "HIDE", "MIRR", "SLAB", "POPS",
    "TOL",  "MNUM", "MOFF", "MAZH", "MEMA", "OEMA", "PZUP", "PPAR", "COMN", "BLNK", "CHZE", "DMFS"};
/* What acts on light, unless all that follows is 0. */
static const char *const acting_words[] = {"COAT", "OBSC", "SQAP", "SQOB", "ELAP", "ELOB", "SPID", "UDAD",
                                           "UDOB", "OBDC", "TELE", "AFOC", "XDAT", "VANN", "SCBD"};
/* After the surfaces, also where a program has dropped the blanks before a surface's lines. */
static const char *const last_words[] = {"TOL", "MNUM", "MOFF", "BLNK"};

static bool is_among(const char *word, const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(word, words[i]) == 0)
            return true;
    return false;
}

/* --- lines that are kept --- */

status lens_zmx_keep(lens_reader *r, long of, const char *line)
{
    char number[24];
    while (*line == ' ' || *line == '\t')
        line++;
    size_t length = strlen(line);
    while (length > 0 && (line[length - 1] == ' ' || line[length - 1] == '\t'))
        length--;
    const size_t head = (size_t)snprintf(number, sizeof number, "%ld ", of);
    if (!GROW(r->p->kept, r->kept_room, r->kept + head + length + 2))
        return out_of_memory(r->why);
    char *to = r->p->kept + r->kept;
    memcpy(to, number, head);
    memcpy(to + head, line, length);
    memcpy(to + head + length, "\n", 2);
    r->kept += head + length + 1;
    return STATUS_OK;
}

/* The next kept line of a surface or of the system, and its end; NULL for none. */
static const char *next_kept(const char *at, long of, const char **ends)
{
    while (at && *at) {
        char *text;
        const long number = strtol(at, &text, 10);
        *ends = strchr(at, '\n');
        if (number == of)
            return text + 1;
        at = *ends + 1;
    }
    return NULL;
}

static bool begins_with(const char *line, const char *word)
{
    const size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && (line[length] == ' ' || line[length] == '\n');
}

void lens_zmx_put_kept(const lens_prescription *p, long of, FILE *out)
{
    const char *ends;
    for (const char *at = next_kept(p->kept, of, &ends); at; at = next_kept(ends + 1, of, &ends))
        if (!begins_with(at, "CURV") && !begins_with(at, "DIAM") && !begins_with(at, "VERS"))
            fprintf(out, "%s%.*s\n", of > 0 ? "  " : "", (int)(ends - at), at);
}

void lens_zmx_put_tail(const lens_prescription *p, long of, const char *word, const char *usual, FILE *out)
{
    const char *ends;
    for (const char *at = next_kept(p->kept, of, &ends); at; at = next_kept(ends + 1, of, &ends))
        if (begins_with(at, word)) {
            at += strlen(word);
            at += of > 0 ? strspn(at, " \t") : 0;
            at += of > 0 ? strcspn(at, " \t\n") : 0;
            fprintf(out, "%.*s\n", (int)(ends - at), at);
            return;
        }
    fprintf(out, "%s\n", usual);
}

/* --- words that are not read --- */

static bool all_zero(const lens_reader *r)
{
    for (int i = 1; i < r->count; i++)
        if (r->word[i][strspn(r->word[i], "+-0.eE")])
            return false;
    return r->count > 1;
}

/* A word of three letters is near to too many. */
static const char *meant_by(const char *word)
{
    const char *found = NULL;
    for (size_t i = 0; i < COUNT(read_words) && strlen(word) > 3; i++)
        if (text_distance(word, read_words[i]) == 1)
            found = read_words[i];
    return found;
}

status lens_zmx_other(lens_reader *r, long of, const char *line)
{
    const char *word = r->word[0];
    char place[48] = "";
    if (is_among(word, last_words, COUNT(last_words)))
        of = of > 0 ? -1 : of;
    else if (of > 0)
        snprintf(place, sizeof place, " of surface %zu", r->p->count - 1);
    if (is_among(word, acting_words, COUNT(acting_words))) {
        if (!all_zero(r))
            lens_note_item(r->p, "not read", strcmp(word, "COAT") == 0 && r->count > 1 ? "%s %.30s%s" : "%s%.0s%s",
                           word, r->count > 1 ? r->word[1] : "", place);
    } else if (!is_among(word, quiet_words, COUNT(quiet_words))) {
        const char *meant = meant_by(word);
        char remedy[64];
        snprintf(remedy, sizeof remedy, "did you mean %s?", meant ? meant : "");
        if (meant)
            return lens_wrong(r, 0, remedy, "unknown word '%.20s'", word);
        lens_note_item(r->p, "unknown words, not read", "%.20s (line %ld)", word, r->line);
    }
    return lens_zmx_keep(r, of, line);
}

/* --- the image --- */

status lens_zmx_check_image(lens_reader *r, bool has_distance)
{
    const lens_prescription *p = r->p;
    if (p->count < 2)
        return STATUS_OK;
    const lens_surface *s = &p->surface[p->count - 1];
    if (s->thickness != 0.0) {
        r->line = s->line;
        return lens_wrong(
            r, -1, "complete the file: it ends with the image, whose DISZ is 0",
            "the last surface, %zu, has a thickness of %g: the image is missing, or the file is cut short",
            p->count - 1, s->thickness);
    }
    if (!has_distance)
        lens_note(r->p, "surface %zu, taken as the image, has no DISZ: is the file cut short?", p->count - 1);
    if (s->mirror || s->medium.kind != LENS_AIR)
        lens_note_item(r->p, "not read", "GLAS of the image");
    return STATUS_OK;
}

/* --- catalogues --- */

void lens_zmx_check_makers(lens_reader *r)
{
    const char *ends, *line = next_kept(r->p->kept, 0, &ends);
    while (line && !begins_with(line, "GCAT"))
        line = next_kept(ends + 1, 0, &ends);
    const char *schott = line ? strstr(line, "SCHOTT") : NULL;
    for (size_t i = 0; line && !(schott && schott < ends) && i < r->p->count; i++) {
        const lens_medium *m = &r->p->surface[i].medium;
        const medium *of = m->kind == LENS_CATALOGUE ? media_find(m->name) : NULL;
        if (of && strncmp(of->title, "Schott", 6) == 0)
            lens_note_item(r->p, "taken as Schott's, which GCAT does not name", "%s", m->name);
    }
}
