/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_ini.h
 * A scenario file as a list of entries in file order, each with its place. Meaning comes later.
 */
#ifndef PS_INI_H
#define PS_INI_H

#include "ps_text.h"

#define PS_INI_ENTRIES 512
#define PS_INI_TEXT 256

typedef struct ps_ini_entry {
    char section[32];
    char key[64]; /**< empty for a line without '=' (section [expect]) */
    char value[PS_INI_TEXT];
    ps_place at;
    bool used;
} ps_ini_entry;

typedef struct ps_ini {
    int count;
    ps_ini_entry entry[PS_INI_ENTRIES];
} ps_ini;

/** Reads `path`, which must outlive `ini`. 0, or -1 with the error recorded. */
int ps_ini_read(ps_ini *ini, const char *path, ps_error *e);

/** Applies `SECTION.KEY=VALUE`: replaces the entry or adds it. `number` is the place reported, as in
 * --set:NUMBER. */
int ps_ini_set(ps_ini *ini, const char *assignment, int number, ps_error *e);

/** The value of a key, marked as used; NULL when absent. `*at` gets its place. */
const char *ps_ini_get(ps_ini *ini, const char *section, const char *key, ps_place *at);

/** Fails on the first entry nobody asked for, and on sections outside the language. */
int ps_ini_all_used(const ps_ini *ini, ps_error *e);

#endif
