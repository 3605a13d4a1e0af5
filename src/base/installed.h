/* Where the files that come with the program are: those of an installation, or those of the sources around a build.
 * The caller frees what is returned. */
#pragma once

/* The folder `below`, such as "experiments/lessons", of share/cuvette next to the program's bin or the library's lib,
 * or of the sources above a build folder; NULL if there is none. Resolved by realpath. */
char *installed_folder(const char *below);

/* The path of the program, or of the file with this code, which may be a shared library; NULL if it is unknown. */
typedef enum code_file { CODE_PROGRAM, CODE_LIBRARY } code_file;
char *code_path(code_file of);
