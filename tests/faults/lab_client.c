/* A client that starts `cuvette lab`, makes requests, and ends it by SIGINT. It prints the replies, numbers apart, so
 * that the oracle compares them; on standard error the error of a reply with 500, or of the server itself, if it ends.
 * A request that failed is made again: the laboratory must have survived. CUVETTE names the program. */
#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { REPLY_MAX = 1 << 21 };

static pid_t server;
static int port;
static char token[64];
static char reply[REPLY_MAX];
static bool any_failed;

static int start(void)
{
    int out[2];
    char here[512], state[600], line[256] = "";
    if (pipe(out) != 0 || !getcwd(here, sizeof here))
        return 3;
    snprintf(state, sizeof state, "%s/../state", here);
    setenv("XDG_STATE_HOME", state, 1);
    server = fork();
    if (server == 0) {
        dup2(out[1], 1);
        close(out[0]);
        close(out[1]);
        execl(getenv("CUVETTE"), "cuvette", "lab", "--no-browser", "--threads", "1", "rod.yaml", (char *)NULL);
        _exit(126);
    }
    close(out[1]);
    FILE *said = fdopen(out[0], "r");
    char *first = said ? fgets(line, sizeof line, said) : NULL;
    return first && sscanf(line, "http://127.0.0.1:%d/?token=%63[0-9a-f]", &port, token) == 2 ? 0 : 1;
}

/* The status of the reply, whose body is then in reply; 0: the connection ended without one. */
static int ask(const char *method, const char *path, const char *body)
{
    char head[1024];
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    struct sockaddr_in to = {
        .sin_family = AF_INET, .sin_port = htons((unsigned short)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    size_t used = 0;
    int status = 0;
    const int length = snprintf(head, sizeof head,
                                "%s %s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n"
                                "Content-Type: application/json\r\nContent-Length: %zu\r\nConnection: close\r\n\r\n%s",
                                method, path, port, token, strlen(body), body);
    if (connect(fd, (struct sockaddr *)&to, sizeof to) == 0 && send(fd, head, (size_t)length, MSG_NOSIGNAL) == length)
        for (ssize_t got; used < sizeof reply - 1 && (got = recv(fd, reply + used, sizeof reply - 1 - used, 0)) > 0;)
            used += (size_t)got;
    close(fd);
    reply[used] = '\0';
    if (sscanf(reply, "HTTP/1.1 %d", &status) != 1)
        return 0;
    const char *at = strstr(reply, "\r\n\r\n");
    const size_t skipped = at ? (size_t)(at + 4 - reply) : used;
    memmove(reply, reply + skipped, used - skipped + 1);
    return status;
}

/* The text of a member of the reply, which is JSON on several lines. */
static void member(const char *name, char *text, size_t size)
{
    char key[32];
    snprintf(key, sizeof key, "\"%s\":\"", name);
    const char *at = strstr(reply, key);
    snprintf(text, size, "%.*s", at ? (int)strcspn(at + strlen(key), "\"") : 0, at ? at + strlen(key) : "");
}

/* The server's own end, as that of the program. */
static int server_status(void)
{
    int state = 0;
    if (waitpid(server, &state, 0) < 0)
        return 3;
    return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
}

static bool has_ended(void)
{
    siginfo_t about = {.si_pid = 0};
    return waitid(P_PID, (id_t)server, &about, WEXITED | WNOHANG | WNOWAIT) == 0 && about.si_pid == server;
}

static void report(int status)
{
    char error[600], remedy[600];
    member("error", error, sizeof error);
    member("remedy", remedy, sizeof remedy);
    if (any_failed)
        return;      /* the same fault, seen by a later request */
    if (status == 0) /* libmicrohttpd drops a connection for which it has no memory, thread or descriptor */
        fprintf(stderr, "cuvette: no reply: memory, threads, open files, Input/output or No space; try again\n");
    else
        fprintf(stderr, "cuvette: %s; %s\n", error, remedy);
}

/* The number of the scene's changes, which each reply to one has. */
static long generation;

static void note_generation(void)
{
    const char *at = strstr(reply, "\"generation\":");
    long now = 0;
    if (at && sscanf(at, "\"generation\":%ld", &now) == 1 && now > generation)
        generation = now;
}

static void show(const char *method, const char *path, int status, bool whole)
{
    printf("%s %s: %d\n", method, path, status);
    if (whole)
        puts(reply);
}

/* whole: the reply is the same in each run, numbers apart. */
typedef struct request {
    const char *method, *path, *body;
    bool whole;
} request;

static const request usual[] = {
    {"GET", "/api/state", "", false},
    {"GET", "/api/scene", "", true},
    {"GET", "/api/params?find=lamp%20brightness", "", true},
    {"POST", "/api/set", "{\"set\": {\"liquid.ior\": 1.4}}", true},
    {"GET", "/api/image.png?wait=1", "", false},
    {"POST", "/api/reference", "{}", false},
    {"POST", "/api/objects/rod/move", "{\"by\": [0.1, 0, 0]}", false},
    {"GET", "/api/image.jpg?wait=1", "", false},
    {"GET", "/api/trace?x=4&y=3", "", true},
    {"GET", "/api/fan?from=-3,1.5,0&to=3,1.5,0&width=1.5&rays=5", "", true},
    {"GET", "/api/section?view=front&cells=40", "", true},
    {"GET", "/api/notes", "", true},
    {"GET", "/api/compare?wait=1", "", false},
    {"GET", "/api/files", "", true},
    {"GET", "/api/media", "", true},
    {"GET", "/api/lessons", "", true},
    {"GET", "/api/link", "", true},
    {"GET", "/api/scene.yaml", "", true},
    {"POST", "/api/undo", "", false},
    {"POST", "/api/save", "{\"file\": \"saved.yaml\"}", false},
    {"GET", "/api/studies", "", true},
    {"GET", "/api/studies/done", "", true},
    {"GET", "/api/studies/done/summary.tsv", "", true},
    {"GET", "/", "", true},
};

/* Objects, files, tables. */
static const request edits[] = {
    {"GET", "/api/scene", "", true},
    {"POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"sphere\", \"set\": {\"radius\": 0.2}}", false},
    {"POST", "/api/objects", "{\"kind\": \"light\", \"name\": \"lamp2\", \"set\": {\"color\": [1, 0.9, 0.8]}}", false},
    {"POST", "/api/objects", "{\"kind\": \"texture\", \"file\": \"tiles.png\", \"name\": \"new\"}", false},
    {"POST", "/api/objects", "{\"kind\": \"model\", \"file\": \"box.obj\", \"name\": \"chest\"}", false},
    {"POST", "/api/objects/vessel/turn", "{\"by\": [0, 10, 0], \"with\": [\"liquid\"]}", false},
    {"POST", "/api/objects/rod/scale", "{\"factor\": 1.1}", false},
    {"POST", "/api/objects/rod/rename", "{\"to\": \"stick\"}", false},
    {"POST", "/api/objects/stick/material", "{\"material\": \"clear\"}", false},
    {"POST", "/api/objects/stick/copy", "{}", false},
    {"GET", "/api/objects/vessel/contents", "", true},
    {"POST", "/api/reset", "{\"paths\": [\"liquid.ior\", \"render.depth\"]}", false},
    {"POST", "/api/undo", "", false},
    {"POST", "/api/redo", "", false},
    {"GET", "/api/scene", "", true},
    {"GET", "/api/command", "", true},
    {"GET", "/api/image.png?wait=1&scene=1", "", false},
    {"GET", "/api/page.html", "", false},
    {"GET", "/api/beams", "", true},
    {"GET", "/api/trace.txt?x=4&y=3", "", true},
    {"GET", "/api/fan.csv?from=-3,1.5,0&to=3,1.5,0&width=1.5&rays=5", "", true},
    {"POST", "/api/save", "{\"file\": \"edited.yaml\"}", false},
    {"POST", "/api/open", "{\"file\": \"rod.yaml\"}", false},
    {"GET", "/api/maps", "", false},
    {"POST", "/api/studies", "{\"file\": \"new.study\", \"axes\": [\"liquid.ior=1.2,1.4\"], \"save\": true}", false},
    {"GET", "/api/studies/done/rows?from=1", "", true},
    {"GET", "/api/studies/done/rows.csv", "", true},
    {"GET", "/api/studies/done/compare?a=render.depth%3D0&b=render.depth%3D8", "", false},
};

/* What takes most time: drawings, and an image of a scene that is not open. */
static const request drawings[] = {
    {"GET", "/api/trace.svg?x=4&y=3", "", true},
    {"GET", "/api/fan.svg?from=-3,1.5,0&to=3,1.5,0&width=1.5&rays=5", "", true},
    {"GET", "/api/section.svg?view=top", "", true},
    {"GET", "/api/thumbnail.jpg?file=rod.yaml", "", false},
};

/* And curves: measurements. */
static const request curves[] = {
    {"GET", "/api/realism", "", true},
    {"GET", "/api/realism/fresnel-s", "", true},
    {"GET", "/api/realism.csv", "", true},
    {"POST", "/api/lessons/critical/open", "{}", false},
    {"GET", "/api/lessons/critical/measure", "", true},
};

/* ends_early: a request that failed and then succeeded is the last one, for the sake of time. */
static const struct scenario {
    const char *name;
    const request *requests;
    size_t count;
    bool ends_early;
} scenarios[] = {{"usual", usual, sizeof usual / sizeof *usual, false},
                 {"edits", edits, sizeof edits / sizeof *edits, false},
                 {"drawings", drawings, sizeof drawings / sizeof *drawings, true},
                 {"curves", curves, sizeof curves / sizeof *curves, true}};

static const struct scenario *find_scenario(const char *name)
{
    size_t i = 0;
    while (i < sizeof scenarios / sizeof *scenarios && strcmp(scenarios[i].name, name) != 0)
        i++;
    return i < sizeof scenarios / sizeof *scenarios ? &scenarios[i] : NULL;
}

/* A change without a reply may have been made: then it is not made twice. */
static int ask_again(const request *r, int status)
{
    const long before = generation;
    report(status);
    any_failed = true;
    usleep(20000);
    if (strcmp(r->method, "POST") == 0 && !r->whole) {
        ask("GET", "/api/scene", "");
        note_generation();
        if (generation > before)
            return 200;
    }
    return ask(r->method, r->path, r->body);
}

/* Changes that could not be kept until they are saved: the page shows why. */
static void look_for_unkept(void)
{
    const int status = ask("GET", "/api/state", "");
    const char *at = strstr(reply, "\"unkept\":{");
    if (at)
        memmove(reply, at, strlen(at) + 1);
    if (at || status == 0 || status >= 500) {
        report(status);
        any_failed = true;
    }
}

int main(int argc, char **argv)
{
    const struct scenario *chosen = find_scenario(argc > 1 ? argv[1] : "usual");
    if (!chosen)
        return 2;
    const request *requests = chosen->requests;
    if (start() != 0) {
        const int code = server_status();
        return code ? code : 1;
    }
    for (size_t i = 0; i < chosen->count && !(any_failed && chosen->ends_early); i++) {
        int status = ask(requests[i].method, requests[i].path, requests[i].body);
        if (status == 0 && has_ended())
            return server_status();
        if (status == 0 || status >= 500)
            status = ask_again(&requests[i], status);
        show(requests[i].method, requests[i].path, status, requests[i].whole);
        note_generation();
        if (status >= 400 && status < 500)
            printf("%s\n", reply);
        if (status == 0 || status >= 500) {
            fprintf(stderr, "lab_client: %s fails again with %d: %.100s\n", requests[i].path, status, reply);
            kill(server, SIGKILL);
            return 4;
        }
    }
    look_for_unkept();
    kill(server, SIGINT);
    const int code = server_status();
    printf("ends with %d\n", code);
    return code != 0 && code != 130 ? code : any_failed;
}
