/* SPDX-License-Identifier: Apache-2.0 */
/* The command table, and the commands that belong to no chip family. */
#include "bqsim_call.h"
#include <stdio.h>
#include <string.h>

#define ECHO_MAX 24 /* characters of a refused word that are repeated */

static const bqsim_text nothing = {NULL, 0};

bqsim_result bqsim_accept(bqsim_call *c, const char *value)
{
    (void)snprintf(c->reply, c->size, value != NULL ? "ok %s" : "ok", value);
    return BQSIM_OK;
}

bqsim_result bqsim_refuse(bqsim_call *c, const char *reason, bqsim_text word)
{
    char echo[ECHO_MAX + 1];
    size_t n = word.n < ECHO_MAX ? word.n : ECHO_MAX;

    for (size_t i = 0; i < n; i++) {
        echo[i] = word.p[i] > ' ' && word.p[i] <= '~' ? word.p[i] : '?';
    }
    echo[n] = '\0';
    (void)snprintf(c->reply, c->size, n > 0 ? "err %s: %s" : "err %s", reason, echo);
    return BQSIM_ERR;
}

bool bqsim_argument(bqsim_call *c, const char *what, bqsim_text *word)
{
    if (!bqsim_word(&c->rest, word)) {
        (void)snprintf(c->reply, c->size, "err missing %s", what);
        return false;
    }
    return true;
}

bool bqsim_end(bqsim_call *c)
{
    bqsim_text word;

    if (bqsim_word(&c->rest, &word)) {
        (void)bqsim_refuse(c, "trailing words", word);
        return false;
    }
    return true;
}

bool bqsim_last_count(bqsim_call *c, const char *what, uint32_t low, uint32_t high, uint32_t *value)
{
    bqsim_text word;

    if (!bqsim_argument(c, what, &word)) {
        return false;
    }
    if (!bqsim_count(word, low, high, value)) {
        char reason[80];

        (void)snprintf(reason, sizeof reason, "%s must be %lu..%lu", what, (unsigned long)low,
                       (unsigned long)high);
        (void)bqsim_refuse(c, reason, word);
        return false;
    }
    return bqsim_end(c);
}

/* ---- paths: the part before the first dot chooses the world ---------------------------------- */

typedef struct world {
    const char *name;
    bqsim_result (*set)(bqsim_call *c, bqsim_text path);
    bqsim_result (*get)(bqsim_call *c, bqsim_text path);
} world;

static const world *find_world(bqsim_call *c, bqsim_text *path)
{
    static const world worlds[] = {
        {"dev", bqsim_stack_set_dev, bqsim_stack_get_dev},
        {"pin", bqsim_stack_set_pin, bqsim_stack_get_pin},
        {"afe", bqsim_afe_set, bqsim_afe_get},
    };
    bqsim_text whole, first;

    if (!bqsim_argument(c, "path", path)) {
        return NULL;
    }
    whole = *path;
    (void)bqsim_part(path, &first);
    for (size_t i = 0; i < sizeof worlds / sizeof worlds[0]; i++) {
        if (bqsim_is(first, worlds[i].name)) {
            return &worlds[i];
        }
    }
    (void)bqsim_refuse(c, "unknown path", whole);
    return NULL;
}

static bqsim_result run_set(bqsim_call *c)
{
    bqsim_text path;
    const world *w = find_world(c, &path);

    return w != NULL ? w->set(c, path) : BQSIM_ERR;
}

static bqsim_result run_get(bqsim_call *c)
{
    bqsim_text path;
    const world *w = find_world(c, &path);

    return w != NULL ? w->get(c, path) : BQSIM_ERR;
}

static bqsim_result run_peek(bqsim_call *c)
{
    bqsim_text path, whole, first;

    if (!bqsim_argument(c, "dev.D or afe", &path)) {
        return BQSIM_ERR;
    }
    whole = path;
    (void)bqsim_part(&path, &first);
    if (bqsim_is(first, "dev")) {
        return bqsim_stack_peek(c, path);
    }
    if (bqsim_is(whole, "afe")) {
        return bqsim_afe_peek(c);
    }
    return bqsim_refuse(c, "unknown chip", whole);
}

/* ---- the other commands ---------------------------------------------------------------------- */

static bqsim_result run_advance(bqsim_call *c)
{
    bqsim_text word;
    uint64_t ns;

    if (!bqsim_argument(c, "time", &word)) {
        return BQSIM_ERR;
    }
    if (!bqsim_time(word, &ns)) {
        return bqsim_refuse(c, "time must be a number >= 0 with us, ms, s, min or h", word);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    if (ns > (uint64_t)INT64_MAX - c->s->now_ns) {
        return bqsim_refuse(c, "beyond the end of simulated time (292 years)", word);
    }
    c->s->now_ns += ns;
    if (c->s->has_stack) {
        sim_pl_advance(&c->s->stack, ns);
    }
    if (c->s->has_afe) {
        sim_x0_advance(&c->s->afe, ns);
    }
    return bqsim_accept(c, NULL);
}

static bqsim_result run_inject(bqsim_call *c)
{
    bqsim_text where;

    if (!bqsim_argument(c, "mosi, miso or sda", &where)) {
        return BQSIM_ERR;
    }
    if (bqsim_is(where, "mosi")) {
        return bqsim_stack_inject(c, &c->s->mosi);
    }
    if (bqsim_is(where, "miso")) {
        return bqsim_stack_inject(c, &c->s->miso);
    }
    if (bqsim_is(where, "sda")) {
        return bqsim_afe_inject(c);
    }
    return bqsim_refuse(c, "inject takes mosi, miso or sda", where);
}

static bqsim_result run_quit(bqsim_call *c)
{
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    (void)bqsim_accept(c, NULL);
    return BQSIM_QUIT;
}

static const struct command {
    const char *name;
    bqsim_result (*run)(bqsim_call *c);
} commands[] = {
    {"stack", bqsim_stack_create},
    {"afe", bqsim_afe_create},
    {"advance", run_advance},
    {"set", run_set},
    {"get", run_get},
    {"peek", run_peek},
    {"inject", run_inject},
    {"spi", bqsim_stack_spi},
    {"i2c", bqsim_afe_i2c},
    {"quit", run_quit},
};

void bqsim_init(bqsim_session *s, sim_vcd *vcd)
{
    memset(s, 0, sizeof *s);
    s->vcd = vcd;
}

/* Without the line end (LF or CRLF) and without a comment. */
static bqsim_text strip(const char *line, size_t length)
{
    bqsim_text t = {line, length};
    const char *comment;

    if (t.n > 0 && t.p[t.n - 1] == '\n') {
        t.n--;
    }
    if (t.n > 0 && t.p[t.n - 1] == '\r') {
        t.n--;
    }
    comment = t.n > 0 ? memchr(t.p, '#', t.n) : NULL;
    if (comment != NULL) {
        t.n = (size_t)(comment - t.p);
    }
    return t;
}

bqsim_result bqsim_exec_n(bqsim_session *s, const char *line, size_t length, char *reply, size_t size)
{
    bqsim_call c = {s, strip(line, length), reply, size};
    bqsim_text name;

    reply[0] = '\0';
    if (!bqsim_word(&c.rest, &name)) {
        return BQSIM_SILENT;
    }
    if (length > BQSIM_LINE_MAX) {
        return bqsim_refuse(&c, "line too long", nothing);
    }
    if (memchr(c.rest.p, '\0', c.rest.n) != NULL) {
        return bqsim_refuse(&c, "NUL in line", nothing);
    }
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        if (bqsim_is(name, commands[i].name)) {
            return commands[i].run(&c);
        }
    }
    return bqsim_refuse(&c, "unknown command", name);
}

bqsim_result bqsim_exec(bqsim_session *s, const char *line, char *reply, size_t size)
{
    return bqsim_exec_n(s, line, strlen(line), reply, size);
}
