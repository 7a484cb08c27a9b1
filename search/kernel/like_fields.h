/* Fields that are alike: of states that differ only in which of them has which value, one stands for all.

   It is the one in which their values ascend.  Source: Pochter, Zohar and Rosenschein, Exploiting problem symmetries in
   state-based planners (2011), for symmetries that exchange variables only. */

#pragma once

#include "lists.h"
#include "problem.h"
#include "values.h"

static void put_code(Word *state, const Field *field, uint64_t value) {
    const int32_t word = field->shift >> 6, bit = field->shift & 63;
    const uint64_t all = ((uint64_t)1 << field->width) - 1;
    state[word] = (state[word] & ~(all << bit)) | value << bit;
    if (bit + field->width <= 64) return;
    state[word + 1] = (state[word + 1] & ~(all >> (64 - bit))) | value >> (64 - bit);
}

/* Keep which fields are alike, class by class, each with NONE at its end; whether there was memory. */
static int set_alike(Ints *alike, const int32_t *fields, int32_t count) {
    alike->count = 0;
    if (left_out & LIKE_FIELDS) return 1;
    for (int32_t i = 0; i < count; i++)
        if (!ints_push(alike, fields[i])) return alike->count = 0, 0;
    return 1;
}

/* Make of a state the one that stands for it; whether it was another one. */
static int represent(const Problem *p, const Ints *alike, Word *state) {
    int moved = 0;
    for (size_t i = 1; i < alike->count; i++) {
        if (alike->at[i] == NONE || alike->at[i - 1] == NONE) continue;
        uint64_t value = code(state, &p->fields[alike->at[i]]), before;
        size_t place = i;
        for (; place && alike->at[place - 1] != NONE; place--) {
            if ((before = code(state, &p->fields[alike->at[place - 1]])) <= value) break;
            put_code(state, &p->fields[alike->at[place]], before);
        }
        if (place == i) continue;
        put_code(state, &p->fields[alike->at[place]], value);
        moved = 1;
    }
    return moved;
}
