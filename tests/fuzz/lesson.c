/* The fuzzer of the lesson reader: any bytes are a lesson or one located error. Its scenes are those of
 * experiments/scenes. */
#include "lesson/lesson.h"
#include "fuzz.h"

/* lessons/fuzz.lesson next to scenes, as in experiments. */
static const char *place_of_lesson(void)
{
    static char path[96];
    if (!path[0]) {
        char *lessons = fuzz_path("lessons"), *scenes = fuzz_path("scenes"),
             *real = realpath("experiments/scenes", NULL);
        must(real && mkdir(lessons, 0700) == 0 && symlink(real, scenes) == 0);
        snprintf(path, sizeof path, "%s/fuzz.lesson", lessons);
        free(lessons);
        free(scenes);
        free(real);
    }
    return path;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *path = place_of_lesson();
    fuzz_write("lessons/fuzz.lesson", data, size);
    lesson *l = NULL;
    diagnostic why = {.what = ""};
    const status code = lesson_read(path, &l, &why);
    if (code != STATUS_OK) {
        must(!l && why.file[0]);
        must_refuse(code, &why);
        return 0;
    }
    char *const made[] = {lesson_x_label(l), lesson_y_label(l), l->over < 0 ? lesson_command(l, true) : NULL,
                          l->metric ? lesson_command(l, false) : NULL};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        free(made[i]);
    must(l->start && l->name && l->title && l->question && l->answer && l->ask && l->control_count >= 1 &&
         l->control_count <= LESSON_CONTROLS_MAX && l->choice_count <= LESSON_CHOICES_MAX);
    lesson_destroy(l);
    return 0;
}
