/* visible OBJECT: makes the hidden symbols of a relocatable ELF file of 64 bits visible, in place, so that a shared
 * library made of it exports them all to test programs. The compiler hides them (-fvisibility=hidden), and no linker
 * undoes that. Of any byte order: with a cross compiler, the file is another machine's. Ends with 1 and a line if the
 * file is none of these. */
#include <elf.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>

typedef struct elf_file {
    unsigned char *bytes;
    uint64_t size;
} elf_file;

static bool is_object(elf_file file)
{
    return file.size >= sizeof(Elf64_Ehdr) && memcmp(file.bytes, ELFMAG, SELFMAG) == 0 &&
           file.bytes[EI_CLASS] == ELFCLASS64;
}

static uint64_t number(elf_file file, uint64_t at, int width)
{
    uint64_t value = 0;
    for (int i = 0; i < width && at + (uint64_t)i < file.size; i++) {
        int byte = file.bytes[EI_DATA] == ELFDATA2LSB ? width - 1 - i : i;
        value = value << 8 | file.bytes[at + (uint64_t)byte];
    }
    return value;
}
#define FIELD(file, at, type, member) number(file, (at) + offsetof(type, member), (int)sizeof(((type *)0)->member))

static void show_symbols(elf_file file, uint64_t at, uint64_t end)
{
    for (; at + sizeof(Elf64_Sym) <= end && end <= file.size; at += sizeof(Elf64_Sym)) {
        unsigned char *other = &file.bytes[at + offsetof(Elf64_Sym, st_other)];
        if (ELF64_ST_VISIBILITY(*other) == STV_HIDDEN)
            *other = (unsigned char)((*other & ~3) | STV_DEFAULT);
    }
}

static void show_all(elf_file file)
{
    uint64_t sections = FIELD(file, 0, Elf64_Ehdr, e_shnum), at = FIELD(file, 0, Elf64_Ehdr, e_shoff);
    if (sections == 0) // too many for the field
        sections = FIELD(file, at, Elf64_Shdr, sh_size);
    for (uint64_t i = 0; i < sections; i++, at += sizeof(Elf64_Shdr)) {
        uint64_t begin = FIELD(file, at, Elf64_Shdr, sh_offset);
        if (FIELD(file, at, Elf64_Shdr, sh_type) == SHT_SYMTAB)
            show_symbols(file, begin, begin + FIELD(file, at, Elf64_Shdr, sh_size));
    }
}

int main(int count, char **arguments)
{
    int descriptor = count == 2 ? open(arguments[1], O_RDWR) : -1;
    struct stat about;
    if (descriptor < 0 || fstat(descriptor, &about) != 0 || about.st_size == 0) {
        fputs("visible: give an object file that can be written\n", stderr);
        return 1;
    }
    elf_file file = {.size = (uint64_t)about.st_size};
    file.bytes = mmap(NULL, (size_t)file.size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    if (file.bytes == MAP_FAILED || !is_object(file)) {
        fprintf(stderr, "visible: %s is no ELF file of 64 bits\n", arguments[1]);
        return 1;
    }
    show_all(file);
    return munmap(file.bytes, (size_t)file.size) == 0 ? 0 : 1;
}
