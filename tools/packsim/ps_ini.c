/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_ini.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

static bool known_section(const char *name)
{
    static const char *const names[] = {"pack", "limits", "run", "load", "events", "expect"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(name, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

static void cut_comment(char *text)
{
    for (size_t i = 0; text[i] != '\0'; i++) {
        if (text[i] == '#' && (i == 0 || isspace((unsigned char)text[i - 1]))) {
            text[i] = '\0';
            return;
        }
    }
}

static ps_ini_entry *find(ps_ini *ini, const char *section, const char *key)
{
    for (int i = 0; i < ini->count; i++) {
        if (strcmp(ini->entry[i].section, section) == 0 && strcmp(ini->entry[i].key, key) == 0) {
            return &ini->entry[i];
        }
    }
    return NULL;
}

static int add(ps_ini *ini, const char *section, const char *key, const char *value, ps_place at, ps_error *e)
{
    if (ini->count == PS_INI_ENTRIES) {
        return ps_fail(e, at, "more than %d entries", PS_INI_ENTRIES);
    }
    ps_ini_entry *x = &ini->entry[ini->count];
    memset(x, 0, sizeof *x);
    if (strlen(key) >= sizeof x->key || strlen(value) >= sizeof x->value) {
        return ps_fail(e, at, "text too long");
    }
    (void)snprintf(x->section, sizeof x->section, "%s", section);
    memcpy(x->key, key, strlen(key) + 1);
    memcpy(x->value, value, strlen(value) + 1);
    x->at = at;
    ini->count++;
    return 0;
}

static int take_section(char *text, char *section, size_t size, ps_place at, ps_error *e)
{
    size_t n = strlen(text);
    if (text[n - 1] != ']') {
        return ps_fail(e, at, "no ] at the end of a section name");
    }
    text[n - 1] = '\0';
    char *name = ps_trim(text + 1);
    if (!known_section(name)) {
        return ps_fail(e, at, "unknown section [%s]", name);
    }
    (void)snprintf(section, size, "%s", name);
    return 0;
}

static int take_entry(ps_ini *ini, char *text, const char *section, ps_place at, ps_error *e)
{
    if (section[0] == '\0') {
        return ps_fail(e, at, "before the first [section]");
    }
    if (strcmp(section, "expect") == 0) {
        return add(ini, section, "", text, at, e);
    }
    char *equals = strchr(text, '=');
    if (equals == NULL) {
        return ps_fail(e, at, "not of the form key = value");
    }
    *equals = '\0';
    char *key = ps_trim(text), *value = ps_trim(equals + 1);
    if (key[0] == '\0' || value[0] == '\0') {
        return ps_fail(e, at, "%s is missing", key[0] == '\0' ? "the key" : "the value");
    }
    if (strcmp(section, "events") != 0 && find(ini, section, key) != NULL) {
        return ps_fail(e, at, "%s given twice in [%s]", key, section);
    }
    return add(ini, section, key, value, at, e);
}

static int take_line(ps_ini *ini, char *text, char *section, size_t size, ps_place at, ps_error *e)
{
    cut_comment(text);
    char *line = ps_trim(text);
    if (line[0] == '\0') {
        return 0;
    }
    return line[0] == '[' ? take_section(line, section, size, at, e) : take_entry(ini, line, section, at, e);
}

int ps_ini_read(ps_ini *ini, const char *path, ps_error *e)
{
    memset(ini, 0, sizeof *ini);
    ps_place at = {path, 0};
    FILE *f = fopen(path, "r");
    if (f == NULL) {
        return ps_fail(e, at, "%s", strerror(errno));
    }
    char text[PS_INI_TEXT + 128], section[32] = "";
    int status = 0;
    while (status == 0 && fgets(text, sizeof text, f) != NULL) {
        at.line++;
        if (strchr(text, '\n') == NULL && strlen(text) + 1 == sizeof text) {
            status = ps_fail(e, at, "line longer than %zu characters", sizeof text - 2);
        } else {
            status = take_line(ini, text, section, sizeof section, at, e);
        }
    }
    if (status == 0 && ferror(f)) {
        status = ps_fail(e, at, "cannot be read");
    }
    (void)fclose(f);
    return status;
}

int ps_ini_set(ps_ini *ini, const char *assignment, int number, ps_error *e)
{
    ps_place at = {"--set", number};
    char text[PS_INI_TEXT + 128];
    if (strlen(assignment) >= sizeof text) {
        return ps_fail(e, at, "text too long");
    }
    (void)snprintf(text, sizeof text, "%s", assignment);
    char *dot = strchr(text, '.'), *equals = strchr(text, '=');
    if (dot == NULL || equals == NULL || dot > equals) {
        return ps_fail(e, at, "%s is not of the form SECTION.KEY=VALUE", assignment);
    }
    *dot = '\0';
    *equals = '\0';
    char *section = ps_trim(text), *key = ps_trim(dot + 1), *value = ps_trim(equals + 1);
    if (!known_section(section)) {
        return ps_fail(e, at, "unknown section [%s]", section);
    }
    if (strcmp(section, "events") == 0 || strcmp(section, "expect") == 0) {
        return ps_fail(e, at, "[%s] has no keys that can be set", section);
    }
    ps_ini_entry *old = find(ini, section, key);
    if (old == NULL) {
        return add(ini, section, key, value, at, e);
    }
    if (strlen(value) >= sizeof old->value) {
        return ps_fail(e, at, "text too long");
    }
    memcpy(old->value, value, strlen(value) + 1);
    old->at = at;
    return 0;
}

const char *ps_ini_get(ps_ini *ini, const char *section, const char *key, ps_place *at)
{
    ps_ini_entry *x = find(ini, section, key);
    if (x == NULL) {
        return NULL;
    }
    x->used = true;
    *at = x->at;
    return x->value;
}

int ps_ini_all_used(const ps_ini *ini, ps_error *e)
{
    for (int i = 0; i < ini->count; i++) {
        const ps_ini_entry *x = &ini->entry[i];
        if (!x->used && strcmp(x->section, "events") != 0 && strcmp(x->section, "expect") != 0) {
            return ps_fail(e, x->at, "unknown key %s in [%s]", x->key, x->section);
        }
    }
    return 0;
}
