/* Loads libmicrohttpd. */
#include "web/http/http_library.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>

mhd_functions mhd;
static bool loaded;
static char reason[256];

static void load(void)
{
    void *library = dlopen("libmicrohttpd.so.12", RTLD_NOW | RTLD_LOCAL);
    loaded = library != NULL;
    const char *said = library ? NULL : dlerror(); /* a text: the loader sets no errno */
    snprintf(reason, sizeof reason, "%s", said ? said : "a function is missing");
#define FIND(name) loaded = loaded && (*(void **)&mhd.name = dlsym(library, "MHD_" #name));
    EACH_MHD_FUNCTION(FIND)
}

status http_library_load(diagnostic *why)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    return loaded ? STATUS_OK
                  : diagnose(why, STATUS_FAILURE, "install libmicrohttpd12, or free memory and open files",
                             "the laboratory needs the library libmicrohttpd, which cannot be loaded: %s", reason);
}
