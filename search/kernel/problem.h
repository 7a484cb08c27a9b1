/* The problem: operators, costs and goal over packed states.

   A state is a row of words with a bit field for each variable; an operator asks by a mask and a value, and is applied by
   two masks.  A fact is a value of a field; facts are numbered field by field. */

#pragma once

#include <stdlib.h>
#include "lists.h"
#include "values.h"

typedef struct {
    int32_t shift, width, offset; /* lowest bit; bits; number of its first fact */
} Field;

typedef struct {
    int32_t words, n_ops, n_fields, n_facts, n_forbidden;
    Word *need_mask, *need, *keep, *put; /* a row per operator */
    Word *forbidden;                     /* two rows, mask and value, per forbidden literal */
    Lists forbids;                       /* per operator its forbidden literals */
    Cost *weight;
    Field *fields;
    Word *goal_mask, *goal, *goal_forbidden;
    int32_t n_goal_forbidden;
    Ints tree;                           /* decision tree over preconditions, see successor_generator.h */
} Problem;

/* The problem as Python tells it. */
typedef struct {
    int32_t words, n_ops, n_fields, n_facts, n_forbidden, n_goal_forbidden;
    const Word *need_mask, *need, *keep, *put;
    const int32_t *forbidding; /* per forbidden literal its operator, ascending */
    const Word *forbidden;
    const Cost *weight;
    const int32_t *fields; /* three numbers each */
    const Word *goal_mask, *goal, *goal_forbidden;
} Spec;

/* Copies what it is told; whether there was memory for it. */
static int problem_new(Problem *p, const Spec *spec) {
    size_t row = (size_t)spec->words * sizeof(Word), ops = (size_t)spec->n_ops;
    p->words = spec->words, p->n_ops = spec->n_ops, p->n_fields = spec->n_fields, p->n_facts = spec->n_facts;
    p->n_forbidden = spec->n_forbidden, p->n_goal_forbidden = spec->n_goal_forbidden;
    p->need_mask = copied(spec->need_mask, ops * row), p->need = copied(spec->need, ops * row);
    p->keep = copied(spec->keep, ops * row), p->put = copied(spec->put, ops * row);
    p->forbidden = copied(spec->forbidden, 2 * row * (size_t)spec->n_forbidden);
    p->weight = copied(spec->weight, ops * sizeof(Cost));
    p->fields = copied(spec->fields, (size_t)spec->n_fields * sizeof(Field));
    p->goal_mask = copied(spec->goal_mask, row), p->goal = copied(spec->goal, row);
    p->goal_forbidden = copied(spec->goal_forbidden, 2 * row * (size_t)spec->n_goal_forbidden);
    int fine = p->need_mask && p->need && p->keep && p->put && p->forbidden && p->weight && p->fields && p->goal_mask &&
               p->goal && p->goal_forbidden;
    Ints which = {0}, number = {0};
    for (int32_t i = 0; fine && i < spec->n_forbidden; i++)
        fine = ints_push(&which, spec->forbidding[i]) && ints_push(&number, i);
    fine = fine && lists_of(&p->forbids, p->n_ops, &which, &number);
    free(which.at), free(number.at);
    return fine;
}

static void problem_free(Problem *p) {
    free(p->need_mask), free(p->need), free(p->keep), free(p->put), free(p->forbidden), free(p->weight);
    free(p->fields), free(p->goal_mask), free(p->goal), free(p->goal_forbidden);
    lists_free(&p->forbids), free(p->tree.at);
}

static uint64_t code(const Word *state, const Field *field) {
    int32_t word = field->shift >> 6, bit = field->shift & 63;
    uint64_t value = state[word] >> bit;
    if (bit + field->width > 64) value |= state[word + 1] << (64 - bit);
    return value & (((uint64_t)1 << field->width) - 1);
}

/* How many values a field has. */
static int32_t values_of(const Problem *p, int32_t field) {
    return (field + 1 < p->n_fields ? p->fields[field + 1].offset : p->n_facts) - p->fields[field].offset;
}

static int matches(const Word *state, const Word *mask, const Word *value, int32_t words) {
    for (int32_t i = 0; i < words; i++)
        if ((state[i] & mask[i]) != value[i]) return 0;
    return 1;
}

/* Whether an operator is applicable in a state. */
static int is_allowed(const Problem *p, int32_t op, const Word *state) {
    size_t row = (size_t)op * p->words;
    if (!matches(state, p->need_mask + row, p->need + row, p->words)) return 0;
    for (int32_t j = p->forbids.start[op]; j < p->forbids.start[op + 1]; j++) {
        const Word *rows = p->forbidden + 2 * (size_t)p->forbids.at[j] * p->words;
        if (matches(state, rows, rows + p->words, p->words)) return 0;
    }
    return 1;
}

static int mentions(const Word *mask, const Field *field) { return code(mask, field) != 0; }

/* The state that an operator makes of one. */
static inline void apply(const Problem *p, int32_t op, const Word *state, Word *made) {
    size_t row = (size_t)op * p->words;
    for (int32_t w = 0; w < p->words; w++) made[w] = (state[w] & p->keep[row + w]) | p->put[row + w];
}

static int is_goal(const Problem *p, const Word *state) {
    if (!matches(state, p->goal_mask, p->goal, p->words)) return 0;
    for (int32_t i = 0; i < p->n_goal_forbidden; i++)
        if (matches(state, p->goal_forbidden + 2 * i * p->words, p->goal_forbidden + (2 * i + 1) * p->words, p->words))
            return 0;
    return 1;
}
