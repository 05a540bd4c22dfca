/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_cells_csv.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_MAX_CHARS 256

static void trim_end(char *s)
{
    size_t n = strlen(s);
    while (n > 0 && isspace((unsigned char)s[n - 1])) {
        s[--n] = '\0';
    }
}

static int parse_pair(const char *text, double *a, double *b)
{
    char *end;
    *a = strtod(text, &end);
    if (end == text || *end != ',') {
        return -1;
    }
    const char *second = end + 1;
    *b = strtod(second, &end);
    if (end == second || *end != '\0' || !isfinite(*a) || !isfinite(*b)) {
        return -1;
    }
    return 0;
}

static const char *take_line(char *text, const char *header, int *header_seen, sim_cells_csv_row row,
                             void *ctx)
{
    if (text[0] == '\0' || text[0] == '#') {
        return NULL;
    }
    if (!*header_seen) {
        *header_seen = 1;
        return strcmp(text, header) == 0 ? NULL : "wrong header line";
    }
    double a = 0.0, b = 0.0;
    if (parse_pair(text, &a, &b) != 0) {
        return "not two numbers with a comma between them";
    }
    return row(ctx, a, b);
}

int sim_cells_csv_read(const char *path, const char *header, sim_cells_csv_row row, void *ctx, char *error,
                       size_t error_size)
{
    FILE *f = fopen(path, "r");
    if (f == NULL) {
        (void)snprintf(error, error_size, "%s:0: %s", path, strerror(errno));
        return -1;
    }
    char text[LINE_MAX_CHARS];
    int header_seen = 0, line = 0;
    const char *reason = NULL;
    while (reason == NULL && fgets(text, sizeof text, f) != NULL) {
        line++;
        if (strchr(text, '\n') == NULL && strlen(text) + 1 == sizeof text) {
            if (text[0] != '#') {
                reason = "line too long";
                break;
            }
            int c;
            while ((c = fgetc(f)) != EOF && c != '\n') {
            }
        }
        trim_end(text);
        reason = take_line(text, header, &header_seen, row, ctx);
    }
    if (reason == NULL && ferror(f)) {
        reason = "cannot be read";
    }
    if (reason == NULL && !header_seen) {
        reason = "no header line";
    }
    (void)fclose(f);
    if (reason != NULL) {
        (void)snprintf(error, error_size, "%s:%d: %s (columns are %s)", path, line, reason, header);
        return -1;
    }
    return 0;
}
