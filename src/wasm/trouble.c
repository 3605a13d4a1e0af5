/* The last error, and the name of the instruction set, for scripts. */
#include "wasm/trouble.h"

#include "base/isa.h"
#include "wasm/exports.h"

static char text[2048];

int trouble_note(status code, const diagnostic *why)
{
    if (code != STATUS_OK)
        diagnostic_text(why, text, sizeof text);
    return (int)code;
}

const char *wasm_why(void)
{
    return text;
}

const char *wasm_isa(void)
{
    return isa_name(isa_best());
}
