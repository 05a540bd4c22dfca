/* SPDX-License-Identifier: Apache-2.0 */
/* Life and bus of the bq769x0. */
#include "bqsim_call.h"
#include <stdio.h>
#include <string.h>

static const bqsim_text nothing = {NULL, 0};

bool bqsim_afe_present(bqsim_call *c)
{
    if (!c->s->has_afe) {
        (void)bqsim_refuse(c, "no afe", nothing);
    }
    return c->s->has_afe;
}

bqsim_result bqsim_afe_create(bqsim_call *c)
{
    bqsim_session *s = c->s;
    bqsim_text word;
    char name[12] = "";
    const sim_x0_part *part;

    if (!bqsim_argument(c, "part", &word)) {
        return BQSIM_ERR;
    }
    if (word.n < sizeof name) {
        memcpy(name, word.p, word.n);
        name[word.n] = '\0';
    }
    part = sim_x0_find_part(name);
    if (part == NULL) {
        return bqsim_refuse(c, "no such part", word);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    if (sim_x0_init(&s->afe, part, &s->afe_options) != 0) {
        return bqsim_refuse(c, "the model refuses these options", nothing);
    }
    s->has_afe = true;
    sim_x0_advance(&s->afe, s->now_ns); /* one time for everything, also in the waveform */
    sim_x0_record(&s->afe, s->vcd);
    return bqsim_accept(c, NULL);
}

bqsim_result bqsim_afe_inject(bqsim_call *c)
{
    uint32_t bit;

    if (!bqsim_afe_present(c) || !bqsim_last_count(c, "bit", 0, 8 * BQSIM_PACKET_MAX - 1, &bit)) {
        return BQSIM_ERR;
    }
    if (sim_x0_flip_sda(&c->s->afe, (int)bit) != 0) {
        return bqsim_refuse(c, "the model refuses this bit", nothing);
    }
    return bqsim_accept(c, NULL);
}

/* ---- i2c: tokens into s->tx and s->rx first, so that a line with a mistake moves nothing -------- */

enum { START = 1, STOP, SEND, READ_ACK, READ_NACK };

static bool token(bqsim_text word, uint8_t *kind, uint8_t *byte)
{
    static const struct {
        const char *word;
        uint8_t kind;
    } letters[] = {{"S", START}, {"P", STOP}, {"r", READ_ACK}, {"n", READ_NACK}};

    for (size_t i = 0; i < sizeof letters / sizeof letters[0]; i++) {
        if (bqsim_is(word, letters[i].word)) {
            *kind = letters[i].kind;
            return true;
        }
    }
    *kind = SEND;
    return bqsim_hex8(word, byte);
}

static char *put_byte(char *p, uint8_t byte)
{
    static const char digit[] = "0123456789abcdef";

    *p++ = digit[byte >> 4];
    *p++ = digit[byte & 15];
    return p;
}

/* Carries out one token and appends its answer. */
static char *carry_out(sim_x0 *afe, uint8_t kind, uint8_t byte, char *p)
{
    *p++ = ' ';
    switch (kind) {
    case START:
        sim_x0_i2c_start(afe);
        *p++ = 'S';
        return p;
    case STOP:
        sim_x0_i2c_stop(afe);
        *p++ = 'P';
        return p;
    case SEND:
        p = put_byte(p, byte);
        *p++ = sim_x0_i2c_write(afe, byte) ? '+' : '-';
        return p;
    default:
        return put_byte(p, sim_x0_i2c_read(afe, kind == READ_ACK));
    }
}

bqsim_result bqsim_afe_i2c(bqsim_call *c)
{
    bqsim_session *s = c->s;
    bqsim_text word;
    size_t n = 0;
    char *p;

    if (!bqsim_afe_present(c)) {
        return BQSIM_ERR;
    }
    while (bqsim_word(&c->rest, &word)) {
        if (n == BQSIM_PACKET_MAX || !token(word, &s->rx[n], &s->tx[n])) {
            return bqsim_refuse(c, "a token is S, P, r, n or two hex digits", word);
        }
        n++;
    }
    if (n == 0) {
        return bqsim_refuse(c, "missing tokens", nothing);
    }
    if (c->size < 4 * n + 3) {
        return bqsim_refuse(c, "reply does not fit", nothing);
    }
    p = c->reply;
    *p++ = 'o';
    *p++ = 'k';
    for (size_t i = 0; i < n; i++) {
        p = carry_out(&s->afe, s->rx[i], s->tx[i], p);
    }
    *p = '\0';
    return BQSIM_OK;
}

bqsim_result bqsim_afe_peek(bqsim_call *c)
{
    bqsim_text word;
    uint8_t reg;
    char text[3];

    if (!bqsim_afe_present(c) || !bqsim_argument(c, "register", &word)) {
        return BQSIM_ERR;
    }
    if (!bqsim_hex8(word, &reg)) {
        return bqsim_refuse(c, "a register is two hex digits", word);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    *put_byte(text, sim_x0_peek(&c->s->afe, reg)) = '\0';
    return bqsim_accept(c, text);
}
