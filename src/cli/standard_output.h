/* Standard output with writes of our own: an interrupted or short write goes on, and the reason of the first write that
 * failed is kept, which stdio forgets. */
#pragma once

/* Call it once, before anything is printed. Out of memory, standard output stays that of stdio. */
void standard_output_prepare(void);
/* The errno of the first write that failed; 0: none. */
int standard_output_error(void);
