/* SPDX-License-Identifier: Apache-2.0 */
/* Where scenarios and data are found. */
#include "ps_options.h"

#include <dirent.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef PS_SOURCE_DIR
#define PS_SOURCE_DIR "."
#endif

void ps_home(char *path, size_t size, const char *argv0, const char *folder)
{
    char real[PATH_MAX];
    const char *slash =
        strchr(argv0, '/') != NULL && realpath(argv0, real) != NULL ? strrchr(real, '/') : NULL;
    if (slash != NULL) {
        static const char *const places[] = {"", "/../share/bqhost/packsim"};
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
            (void)snprintf(path, size, "%.*s%s/%s", (int)(slash - real), real, places[i], folder);
            if (access(path, R_OK | X_OK) == 0) {
                return;
            }
        }
    }
    (void)snprintf(path, size, "%s/%s", PS_SOURCE_DIR, folder);
}

void ps_find_scenario(char *path, size_t size, const char *name, const char *folder)
{
    (void)snprintf(path, size, "%s", name);
    if (strchr(name, '/') != NULL || access(name, R_OK) == 0) {
        return;
    }
    size_t n = strlen(name);
    bool has_suffix = n > 4 && strcmp(name + n - 4, ".ini") == 0;
    char candidate[PS_PATH];
    (void)snprintf(candidate, sizeof candidate, "%s/%s%s", folder, name, has_suffix ? "" : ".ini");
    if (access(candidate, R_OK) == 0) {
        (void)snprintf(path, size, "%s", candidate);
    }
}

static int is_scenario(const struct dirent *d)
{
    size_t n = strlen(d->d_name);
    return n > 4 && strcmp(d->d_name + n - 4, ".ini") == 0;
}

static void list_one(FILE *to, const char *folder, const char *file)
{
    char path[PS_PATH], line[512], *text = line;
    (void)snprintf(path, sizeof path, "%s/%s", folder, file);
    FILE *f = fopen(path, "r");
    line[0] = '\0';
    while (f != NULL && fgets(line, sizeof line, f) != NULL) {
        text = ps_trim(line);
        if (text[0] == '#' && strstr(text, "SPDX-License") == NULL) {
            break;
        }
        line[0] = '\0';
    }
    if (f != NULL) {
        (void)fclose(f);
    }
    text = text[0] == '#' ? ps_trim(text + 1) : text;
    (void)fprintf(to, "%-24.*s %s\n", (int)strlen(file) - 4, file, text);
}

int ps_list(FILE *to, const char *folder)
{
    struct dirent **names = NULL;
    int n = scandir(folder, &names, is_scenario, alphasort);
    if (n < 0) {
        return -1;
    }
    for (int i = 0; i < n; i++) {
        list_one(to, folder, names[i]->d_name);
        free(names[i]);
    }
    free(names);
    return 0;
}
