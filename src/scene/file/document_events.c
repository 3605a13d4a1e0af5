#include "scene/file/document_events.h"

#include <stdbool.h>

status events_error(event_reader *r, yaml_mark_t mark, const char *remedy, const char *what)
{
    diagnostic_locate(r->why, r->name, (long)mark.line + 1, (long)mark.column + 1);
    return diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s", what);
}

static bool is_utf8_follower(char c)
{
    return ((unsigned char)c & 0xc0) == 0x80;
}

/* Line and column (in characters) of a byte: libyaml only gives the byte where decoding failed. */
static yaml_mark_t mark_of_byte(const event_reader *r, size_t offset)
{
    yaml_mark_t mark = {.index = 0, .line = 0, .column = 0};
    for (size_t i = 0; i < offset && i < r->size; i++) {
        if (r->text[i] == '\n') {
            mark.line++;
            mark.column = 0;
        } else if (!is_utf8_follower(r->text[i])) {
            mark.column++;
        }
    }
    return mark;
}

static bool tab_stands_at(const event_reader *r, yaml_mark_t mark)
{
    size_t line = 0, i = 0;
    while (i < r->size && line < mark.line)
        line += r->text[i++] == '\n';
    for (size_t column = 0; i < r->size && r->text[i] != '\n' && column < mark.column; column++)
        i++;
    return i < r->size && r->text[i] == '\t';
}

static status syntax_error(event_reader *r)
{
    const yaml_parser_t *p = &r->parser;
    switch (p->error) {
    case YAML_MEMORY_ERROR: return out_of_memory(r->why);
    case YAML_READER_ERROR:
        return events_error(r, mark_of_byte(r, p->problem_offset), "save the file as plain UTF-8 text",
                            p->problem ? p->problem : "the file is not text");
    case YAML_NO_ERROR:
    case YAML_SCANNER_ERROR:
    case YAML_PARSER_ERROR:
    case YAML_COMPOSER_ERROR:
    case YAML_WRITER_ERROR:
    case YAML_EMITTER_ERROR: break;
    }
    const char *remedy = tab_stands_at(r, p->problem_mark) ? "indent with spaces instead of tabs"
                                                           : "check the indentation, colons, brackets and quotes here";
    diagnostic_locate(r->why, r->name, (long)p->problem_mark.line + 1, (long)p->problem_mark.column + 1);
    return diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s%s%s", p->context ? p->context : "", p->context ? ", " : "",
                    p->problem ? p->problem : "invalid YAML");
}

/* The next event; constructs that scene and study files exclude (aliases, anchors, tags) are refused here. */
status events_next(event_reader *r, yaml_event_t *event)
{
    if (!yaml_parser_parse(&r->parser, event))
        return syntax_error(r);
    const yaml_char_t *anchor = NULL, *tag = NULL;
    if (event->type == YAML_ALIAS_EVENT)
        anchor = event->data.alias.anchor;
    else if (event->type == YAML_SCALAR_EVENT)
        anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
    else if (event->type == YAML_SEQUENCE_START_EVENT)
        anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
    else if (event->type == YAML_MAPPING_START_EVENT)
        anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
    if (!anchor && !tag)
        return STATUS_OK;
    status code = events_error(r, event->start_mark, "write the value where it is used",
                               anchor ? "anchors and aliases (& and *) are not allowed" : "tags (!) are not allowed");
    yaml_event_delete(event);
    return code;
}
