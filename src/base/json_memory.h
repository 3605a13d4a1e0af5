/* jansson 2.14 ends the program, or loses characters in silence, when memory runs out while it parses or copies a
 * value. A program that calls this first, before any value is made, gives it a reserve for that moment, so that values
 * stay whole; the library does not, since the functions that allocate for jansson are those of the whole process. Texts
 * of json_dumps may then not be released with free: use json_text (json_build.h). */
#pragma once

void json_memory_reserve(void);
