#include "study/row_environments.h"
#include "base/array.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status row_environments_find(const row_files *files, row_environment_count **out, size_t *count, diagnostic *why)
{
    *out = NULL;
    *count = 0;
    for (size_t i = 0, at = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        if (at >= *count || strcmp((*out)[at].key, ref->environment) != 0)
            for (at = 0; at < *count && strcmp((*out)[at].key, ref->environment) != 0; at++) {
            }
        if (at == *count) {
            if (!room_for_one(out, *count, sizeof **out)) {
                free(*out);
                *out = NULL;
                return out_of_memory(why);
            }
            (*out)[(*count)++] = (row_environment_count){.rows = 0};
            memcpy((*out)[at].key, ref->environment, ENVIRONMENT_KEY);
        }
        (*out)[at].rows += !ref->warmup;
        if (ref->run >= 0)
            (*out)[at].run = &files->runs->entry[ref->run];
    }
    return STATUS_OK;
}

status row_environments_main(const row_files *files, char key[ENVIRONMENT_KEY], diagnostic *why)
{
    row_environment_count *all;
    size_t count, most = 0;
    TRY(row_environments_find(files, &all, &count, why));
    for (size_t i = 1; i < count; i++)
        most = all[i].rows >= all[most].rows ? i : most;
    key[0] = 0;
    if (count > 0)
        memcpy(key, all[most].key, ENVIRONMENT_KEY);
    free(all);
    return STATUS_OK;
}

status row_environments_choose(const row_files *files, const char *text, char key[ENVIRONMENT_KEY], diagnostic *why)
{
    key[0] = 0;
    if (!text)
        return STATUS_OK;
    if (strcmp(text, "main") == 0)
        return row_environments_main(files, key, why);
    row_environment_count *all;
    size_t count, at = 0;
    char remedy[300] = "give one of these: ";
    TRY(row_environments_find(files, &all, &count, why));
    while (at < count && strcmp(all[at].key, text) != 0)
        at++;
    for (size_t i = 0; i < count && strlen(remedy) + ENVIRONMENT_KEY + 2 < sizeof remedy; i++)
        snprintf(remedy + strlen(remedy), sizeof remedy - strlen(remedy), "%s%s", i ? ", " : "", all[i].key);
    const status code =
        at < count ? STATUS_OK : diagnose(why, STATUS_BAD_INPUT, remedy, "no row is of the environment '%.64s'", text);
    if (code == STATUS_OK)
        memcpy(key, all[at].key, ENVIRONMENT_KEY);
    free(all);
    return code;
}
