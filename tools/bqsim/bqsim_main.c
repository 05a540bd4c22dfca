/* SPDX-License-Identifier: Apache-2.0 */
/* bqsim [--vcd FILE] [SCRIPT]: the chip simulator on a pipe. */
#include "bqsim.h"
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXIT_ACCEPTED = 0, EXIT_REFUSED = 1, EXIT_UNREADABLE = 2 };

typedef struct program {
    bqsim_session session;
    sim_vcd vcd;
    bool refused; /* a command was refused, or a reply or the waveform could not be written */
    char line[BQSIM_LINE_MAX + 4];
    char reply[BQSIM_REPLY_MAX];
} program;

/* One line without its LF into p->line. Returns its length, which is larger than BQSIM_LINE_MAX when its end
 * was cut off; -1 at the end of the input. */
static long read_line(program *p, FILE *in)
{
    size_t n = 0;
    int ch;

    while ((ch = getc(in)) != EOF && ch != '\n') {
        if (n < sizeof p->line) {
            p->line[n++] = (char)ch;
        }
    }
    return ch == EOF && n == 0 ? -1 : (long)n;
}

/* False when the replies cannot be written any more. */
static bool put_reply(const program *p)
{
    return fputs(p->reply, stdout) != EOF && putc('\n', stdout) != EOF && fflush(stdout) == 0;
}

static void run(program *p, FILE *in)
{
    long n;

    while ((n = read_line(p, in)) >= 0) {
        bqsim_result result = bqsim_exec_n(&p->session, p->line, (size_t)n, p->reply, sizeof p->reply);

        if (result == BQSIM_SILENT) {
            continue;
        }
        if (result == BQSIM_ERR) {
            p->refused = true;
        }
        if (!put_reply(p)) {
            p->refused = true;
            return;
        }
        if (result == BQSIM_QUIT) {
            return;
        }
    }
}

static int complain(const char *what, const char *name)
{
    (void)fprintf(stderr, "bqsim: %s: %s\n", what, name);
    return EXIT_UNREADABLE;
}

static int usage(void)
{
    (void)fputs("usage: bqsim [--vcd FILE] [SCRIPT]\n", stderr);
    return EXIT_UNREADABLE;
}

static int run_script(program *p, FILE *in, const char *script, const char *vcd)
{
    bool unreadable;

    if (vcd != NULL && sim_vcd_open(&p->vcd, vcd) != 0) {
        return complain(vcd, strerror(errno));
    }
    bqsim_init(&p->session, vcd != NULL ? &p->vcd : NULL);
    run(p, in);
    unreadable = ferror(in) != 0;
    if (vcd != NULL && sim_vcd_close(&p->vcd, p->session.now_ns) != 0) {
        (void)complain(vcd, "waveform could not be written");
        p->refused = true;
    }
    if (unreadable) {
        return complain(script != NULL ? script : "standard input", "cannot be read");
    }
    return p->refused ? EXIT_REFUSED : EXIT_ACCEPTED;
}

static bool arguments(int argc, char **argv, const char **vcd, const char **script)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--vcd") == 0 && *vcd == NULL && i + 1 < argc) {
            *vcd = argv[++i];
        } else if (argv[i][0] != '-' && *script == NULL) {
            *script = argv[i];
        } else {
            return false;
        }
    }
    return true;
}

int main(int argc, char **argv)
{
    const char *vcd = NULL, *script = NULL;
    FILE *in = stdin;
    program *p;
    int result;

    if (!arguments(argc, argv, &vcd, &script)) {
        return usage();
    }
    if (script != NULL && (in = fopen(script, "r")) == NULL) {
        return complain(script, strerror(errno));
    }
    (void)signal(SIGPIPE,
                 SIG_IGN); /* a reader that went away ends the run with status 1, and the waveform complete */
    p = calloc(1, sizeof *p);
    if (p == NULL) {
        return complain("memory", strerror(errno));
    }
    result = run_script(p, in, script, vcd);
    free(p);
    if (script != NULL) {
        (void)fclose(in);
    }
    return result;
}
