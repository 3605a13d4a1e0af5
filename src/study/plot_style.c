/* The style of all figures, embedded by the assembler. */
#include "study/plot_parts.h"

__asm__(".pushsection .rodata\n.globl plot_style\n.hidden plot_style\nplot_style: .incbin \"plots/style.gp\"\n.byte "
        "0\n.popsection");
