/* The problem seen on a pattern, a few of its fields: abstract states, transitions between them, goals.

   Operators that look alike there are one class.  Source: Edelkamp, Planning with pattern databases (2001). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "problem.h"
#include "values.h"

typedef struct {
    Ints fields;
    int64_t *strides;
    int32_t n_states, n_classes;
    Lists members;           /* per class its operators */
    int32_t *source, *class; /* of each transition, by target */
    int32_t *first;          /* per target its first transition */
    uint8_t *goals;
} Projection;

static int64_t number_of(const Problem *p, const Projection *b, const Word *state) {
    int64_t number = 0;
    for (size_t i = 0; i < b->fields.count; i++)
        number += (int64_t)code(state, &p->fields[b->fields.at[i]]) * b->strides[i];
    return number;
}

/* What an operator asks of a field in the pattern, and what it makes of it; NONE: nothing. */
static void seen(const Problem *p, const Projection *b, int32_t op, int32_t *asks, int32_t *makes) {
    size_t row = (size_t)op * p->words;
    for (size_t i = 0; i < b->fields.count; i++) {
        const Field *field = &p->fields[b->fields.at[i]];
        asks[i] = mentions(p->need_mask + row, field) ? (int32_t)code(p->need + row, field) : NONE;
        int sets = code(p->keep + row, field) != ((uint64_t)1 << field->width) - 1;
        makes[i] = sets ? (int32_t)code(p->put + row, field) : NONE;
        if (makes[i] == asks[i]) makes[i] = NONE;
    }
}

/* By how operators look in a pattern, each a row: how many numbers say so, these numbers, the operator. */
static int compare_looks(const void *a, const void *b) {
    const int32_t *x = *(int32_t *const *)a, *y = *(int32_t *const *)b;
    int32_t width = x[0];
    int order = memcmp(x + 1, y + 1, (size_t)width * sizeof *x);
    return order ? order : (x[width + 1] > y[width + 1]) - (x[width + 1] < y[width + 1]);
}

static void projection_free(Projection *b) {
    free(b->fields.at), free(b->strides), lists_free(&b->members), free(b->source), free(b->class), free(b->first);
    free(b->goals);
}

/* Do `body` for all states `from` and `to` between which a class of operators leads; k is the size of the pattern. */
#define FOR_EACH_TRANSITION(look, k, body)                                                        \
    {                                                                                             \
        int64_t from = 0, shift = 0;                                                              \
        int32_t free_at[64], turn[64];                                                            \
        int n_free = 0;                                                                           \
        for (size_t i_ = 0; i_ < (k); i_++) {                                                     \
            int32_t asks_ = (look)[i_], makes_ = (look)[(k) + i_];                                \
            if (asks_ != NONE) from += asks_ * b->strides[i_];                                    \
            else free_at[n_free] = (int32_t)i_, turn[n_free++] = 0;                               \
            if (asks_ != NONE && makes_ != NONE) shift += (makes_ - asks_) * b->strides[i_];      \
        }                                                                                         \
        for (;;) {                                                                                \
            int64_t to = from + shift;                                                            \
            for (int j_ = 0; j_ < n_free; j_++) {                                                 \
                int32_t makes_ = (look)[(k) + free_at[j_]];                                       \
                if (makes_ != NONE) to += (makes_ - turn[j_]) * b->strides[free_at[j_]];          \
            }                                                                                     \
            if (to != from) body;                                                                 \
            int j_ = 0;                                                                           \
            for (; j_ < n_free; j_++) {                                                           \
                int64_t stride_ = b->strides[free_at[j_]];                                        \
                from += stride_;                                                                  \
                if (++turn[j_] < values_of(p, b->fields.at[free_at[j_]])) break;                  \
                from -= turn[j_] * stride_, turn[j_] = 0;                                         \
            }                                                                                     \
            if (j_ == n_free) break;                                                              \
        }                                                                                         \
    }

static int goal_state(const Problem *p, const Projection *b, int64_t number) {
    for (size_t i = b->fields.count; i-- > 0;) {
        const Field *field = &p->fields[b->fields.at[i]];
        int32_t value = (int32_t)(number / b->strides[i]);
        number -= value * b->strides[i];
        if (mentions(p->goal_mask, field) && (int32_t)code(p->goal, field) != value) return 0;
        for (int32_t j = 0; j < p->n_goal_forbidden; j++) {
            const Word *mask = p->goal_forbidden + 2 * (size_t)j * p->words;
            if (mentions(mask, field) && (int32_t)code(mask + p->words, field) == value) return 0;
        }
    }
    return 1;
}

/* Classes of operators and the transitions between states; 0: too many, or no memory. */
static int find_transitions(Projection *b, const Problem *p, int64_t most_transitions) {
    size_t k = b->fields.count;
    int32_t width = (int32_t)(2 * k), count = 0;
    int32_t *looks = malloc(((size_t)p->n_ops + 1) * (size_t)(width + 2) * sizeof *looks);
    int32_t **order = malloc(((size_t)p->n_ops + 1) * sizeof *order);
    int fine = looks && order;
    for (int32_t op = 0; fine && op < p->n_ops; op++) {
        int32_t *look = looks + (size_t)count * (size_t)(width + 2);
        look[0] = width, look[width + 1] = op;
        seen(p, b, op, look + 1, look + 1 + k);
        int changes = 0;
        for (size_t i = 0; i < k; i++) changes |= look[1 + k + i] != NONE;
        if (changes) order[count++] = look;
    }
    Ints which = {0}, member = {0}, source = {0}, class = {0}, target = {0};
    if (fine) qsort(order, (size_t)count, sizeof *order, compare_looks);
    for (int32_t i = 0; fine && i < count; i++) {
        if (!i || memcmp(order[i], order[i - 1], ((size_t)width + 1) * sizeof(int32_t))) b->n_classes++;
        fine = ints_push(&which, b->n_classes - 1) && ints_push(&member, order[i][width + 1]);
    }
    fine = fine && lists_of(&b->members, b->n_classes, &which, &member);
    int32_t c = NONE;
    for (int32_t i = 0; fine && i < count; i++) {
        if (i && !memcmp(order[i], order[i - 1], ((size_t)width + 1) * sizeof(int32_t))) continue;
        c++;
        const int32_t *look = order[i] + 1;
        FOR_EACH_TRANSITION(look, k, {
            fine = fine && ints_push(&source, (int32_t)from) && ints_push(&target, (int32_t)to) && ints_push(&class, c);
        })
        if ((int64_t)source.count > most_transitions) fine = 0;
    }
    b->first = calloc((size_t)b->n_states + 2, sizeof *b->first);
    b->source = malloc((source.count + 1) * sizeof *b->source), b->class = malloc((source.count + 1) * sizeof *b->class);
    fine = fine && b->first && b->source && b->class;
    if (fine) {
        for (size_t i = 0; i < target.count; i++) b->first[target.at[i] + 1]++;
        for (int32_t i = 0; i < b->n_states; i++) b->first[i + 1] += b->first[i];
        for (size_t i = target.count; i-- > 0;) {
            int32_t place = --b->first[target.at[i] + 1];
            b->source[place] = source.at[i], b->class[place] = class.at[i];
        }
        /* first[t + 1] went down to where the transitions of t begin */
        memmove(b->first, b->first + 1, (size_t)b->n_states * sizeof *b->first);
        b->first[b->n_states] = (int32_t)source.count;
    }
    free(looks), free(order), free(which.at), free(member.at), free(source.at), free(class.at), free(target.at);
    return fine;
}

/* On the fields with these numbers, ascending; 0: too many transitions, or no memory. */
static int projection_new(Projection *b, const Problem *p, const int32_t *fields, int32_t count, int64_t most_transitions) {
    memset(b, 0, sizeof *b);
    b->strides = malloc(((size_t)count + 1) * sizeof *b->strides);
    int64_t size = 1;
    int fine = b->strides != NULL;
    for (int32_t i = 0; fine && i < count; i++) {
        b->strides[i] = size, size *= values_of(p, fields[i]);
        fine = ints_push(&b->fields, fields[i]);
    }
    b->n_states = (int32_t)size;
    fine = fine && find_transitions(b, p, most_transitions) && (b->goals = malloc((size_t)size));
    for (int64_t i = 0; fine && i < size; i++) b->goals[i] = (uint8_t)goal_state(p, b, i);
    if (!fine) projection_free(b);
    return fine;
}
