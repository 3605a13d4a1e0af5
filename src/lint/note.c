/* Formats a note, and passes it to the callback or writes it as a line. */
#include "lint/lint.h"

#include <stdarg.h>
#include <stdio.h>

void note_report(const note_sink *taker, const char *object, const char *parameter, const char *remedy,
                 const char *text, ...)
{
    scene_note note;
    va_list arguments;
    snprintf(note.place, sizeof note.place, "%s%s%s", object ? object : "", object && parameter ? "." : "",
             parameter ? parameter : "");
    snprintf(note.remedy, sizeof note.remedy, "%s", remedy ? remedy : "");
    va_start(arguments, text);
    vsnprintf(note.text, sizeof note.text, text, arguments);
    va_end(arguments);
    taker->take(taker->context, &note);
}

char *note_line(const scene_note *note, char *line, size_t size)
{
    snprintf(line, size, "%s%s%s%s%s", note->place, note->place[0] ? ": " : "", note->text, note->remedy[0] ? "; " : "",
             note->remedy);
    return line;
}
