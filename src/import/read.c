/* Reading of a mesh file with assimp, and the explanation of its errors. */
#include "import/import.h"

#include "base/file.h"
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <jansson.h>
#include <string.h>

/* Equal vertices are joined in join.c: assimp's own step also joins vertices that differ by up to 1e-5. */
enum { STEPS = aiProcess_ValidateDataStructure | aiProcess_Triangulate };

status no_memory_for(const request *req, diagnostic *why)
{
    return diagnose_at(why, req->path, STATUS_BAD_INPUT, "use a mesh of less detail, if the file is complete",
                       "the file requires more memory than the limit of %llu MiB", (unsigned long long)req->memory_mib);
}

/* Reports the position of a JSON error, which assimp does not. True if the file has one. */
static bool locate_json(const request *req, diagnostic *why)
{
    json_error_t error;
    FILE *stream = files_open(req);
    if (!stream)
        return false;
    json_t *root = json_loadf(stream, JSON_REJECT_DUPLICATES, &error);
    fclose(stream);
    if (!root) {
        diagnostic_locate(why, req->path, error.line, error.column);
        diagnose(why, STATUS_BAD_INPUT, "a .gltf file is JSON; binary glTF files end in .glb", "%s", error.text);
    }
    return !root;
}

/* Converts an error message of assimp to a diagnostic. */
static status explain(const request *req, const file_access *access, const char *message, diagnostic *why)
{
    static const char *const names[] = {"OBJ", "PLY", "STL", "glTF 2.0", "binary glTF 2.0 (glb)"};
    diagnostic_locate(why, req->path, 0, 0);
    if (access->outside)
        return diagnose(why, STATUS_BAD_INPUT, BELOW_REMEDY, "needs the file '%s', which %s", access->missing,
                        access->reason);
    if (access->missing[0])
        return diagnose(
            why, STATUS_BAD_INPUT, "put the image where the mesh file expects it, or remove the line that names it",
            "needs the file '%s': %s", access->missing, access->reason ? access->reason : "cannot be opened");
    if (strstr(message, "bad_alloc") || strstr(message, "length_error") || strstr(message, "bad_array_new_length") ||
        strstr(message, "_M_") || strstr(message, "max_size"))
        return no_memory_for(req, why);
    if (req->kind == FILE_GLTF && locate_json(req, why))
        return STATUS_BAD_INPUT;
    if (!*message || strstr(message, "No suitable reader"))
        return diagnose(why, STATUS_BAD_INPUT, "check that the file is complete and has the right ending",
                        "this is not a file of format %s", names[req->kind]);
    return diagnose(why, STATUS_BAD_INPUT, "repair the file or export it again", "cannot read: %.300s", message);
}

status read_scene(const request *req, const struct aiScene **out, diagnostic *why)
{
    file_access access;
    diagnostic_locate(why, req->path, 0, 0);
    TRY(files_check(req, why));
    if (req->kind == FILE_UNKNOWN)
        return diagnose(why, STATUS_BAD_INPUT, "use a file that ends in .obj, .ply, .stl, .gltf or .glb",
                        "unknown mesh format");
    TRY(check_whole(req, why));
    files_prepare(&access, req);
    const struct aiScene *scene = aiImportFileEx(req->path, STEPS, &access.io);
    if (!scene || access.missing[0]) {
        const char *message = scene ? "" : aiGetErrorString();
        return explain(req, &access, message ? message : "", why);
    }
    *out = scene;
    return STATUS_OK;
}

const struct aiScene *read_scene_text(const request *req, const char *text, size_t length)
{
    file_access access;
    files_prepare(&access, req);
    access.path = req->path;
    access.text = text;
    access.text_length = length;
    const struct aiScene *scene = aiImportFileEx(req->path, STEPS, &access.io);
    return access.missing[0] ? NULL : scene;
}
