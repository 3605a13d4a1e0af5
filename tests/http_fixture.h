/* A client over plain sockets for tests of web/http/http.h. Ownership: the caller frees returned strings and closes
 * sockets. A server that never answers gives the reply "" after READ_LIMIT_S instead of a test that hangs. */
#pragma once

#include "base/text.h"
#include "web/http/http_private.h"
#include <arpa/inet.h>
#include <stdbool.h>
#include <dirent.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

enum { READ_LIMIT_S = 120 };

static inline int client_connect(int port)
{
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const struct timeval limit = {.tv_sec = READ_LIMIT_S};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    const struct sockaddr_in there = {
        .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    assert_true(fd >= 0);
    assert_int_equal(connect(fd, (const struct sockaddr *)&there, sizeof there), 0);
    return fd;
}

/* Sends until done or until the server closes, which is no error. */
static inline bool client_send(int fd, const void *bytes, size_t size)
{
    for (const char *at = bytes; size;) {
        const ssize_t sent = send(fd, at, size, MSG_NOSIGNAL);
        if (sent <= 0)
            return false;
        at += sent;
        size -= (size_t)sent;
    }
    return true;
}

/* Reads until the server closes. */
static inline char *client_read_all(int fd)
{
    char *text = NULL;
    size_t size = 0, room = 0;
    for (;;) {
        if (room - size < 4096)
            text = realloc(text, room = 2 * room + 8192);
        const ssize_t got = recv(fd, text + size, room - size - 1, 0);
        if (got < 0 &&
            errno == EINTR) /* a child of the server ended; with a receive timeout, recv is not restarted (signal(7)) */
            continue;
        if (got <= 0)
            break;
        size += (size_t)got;
    }
    text[size] = 0;
    return text;
}

static inline char *client_raw(int port, const void *bytes, size_t size)
{
    const int fd = client_connect(port);
    client_send(fd, bytes, size);
    char *reply = client_read_all(fd);
    close(fd);
    return reply;
}

/* heads: further header lines, each ended by \r\n; body may be NULL. */
static inline char *client_ask_as(int port, const char *method, const char *target, const char *heads, const char *body)
{
    char *request = body ? text_format("%s %s HTTP/1.1\r\nConnection: close\r\nContent-Length: %zu\r\n%s\r\n%s", method,
                                       target, strlen(body), heads, body)
                         : text_format("%s %s HTTP/1.1\r\nConnection: close\r\n%s\r\n", method, target, heads);
    char *reply = client_raw(port, request, strlen(request));
    free(request);
    return reply;
}

/* Sends the request with the Host header and the token. */
static inline char *client_ask(const http_server *s, const char *method, const char *target, const char *heads,
                               const char *body)
{
    char *all = text_format("Host: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n%s", http_port(s), http_token(s), heads);
    char *reply = client_ask_as(http_port(s), method, target, all, body);
    free(all);
    return reply;
}

static inline int reply_code(const char *reply)
{
    return strncmp(reply, "HTTP/1.1 ", 9) == 0 ? atoi(reply + 9) : 0;
}

static inline const char *reply_body(const char *reply)
{
    const char *end = strstr(reply, "\r\n\r\n");
    return end ? end + 4 : "";
}

/* Do the reply's headers contain that line? */
static inline bool reply_has(const char *reply, const char *line)
{
    char *whole = text_format("\r\n%s\r\n", line);
    const char *at = strstr(reply, whole);
    const bool has = at && at < reply_body(reply);
    free(whole);
    return has;
}

static inline int count_entries(const char *folder)
{
    int count = 0;
    DIR *d = opendir(folder);
    while (readdir(d))
        count++;
    closedir(d);
    return count;
}

/* A route that answers with the request's body. */
static inline void echo(void *context, const http_request *q, http_reply *r)
{
    (void)context;
    char *copy = malloc(q->body_size + 1);
    memcpy(copy, q->body ? q->body : "", q->body_size + 1);
    http_reply_bytes(r, 200, "text/plain", copy, q->body_size);
}
