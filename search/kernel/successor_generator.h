/* Which operators are applicable: a decision tree over what they ask for.

   Source: successor generators of Helmert, The Fast Downward planning system (2006). */

#pragma once

#include <stdlib.h>
#include "lists.h"
#include "problem.h"
#include "values.h"

/* Operators whose remaining preconditions are on fields in `left`, as a tree in one array.
   Leaf: NONE, count, operators.  Branch: field, place of the child for each value, place of the child for
   operators that don't ask for the field. */
static int32_t plant(Problem *p, const int32_t *ops, int32_t count, char *done) {
    Ints *tree = &p->tree;
    int32_t best = NONE, most = 0;
    for (int32_t f = 0; f < p->n_fields; f++) {
        if (done[f]) continue;
        int32_t asking = 0;
        for (int32_t i = 0; i < count; i++) asking += mentions(p->need_mask + (size_t)ops[i] * p->words, &p->fields[f]);
        if (asking > most) most = asking, best = f;
    }
    int32_t place = (int32_t)tree->count;
    if (best == NONE) {
        if (!ints_push(tree, NONE) || !ints_push(tree, count)) return NONE;
        for (int32_t i = 0; i < count; i++)
            if (!ints_push(tree, ops[i])) return NONE;
        return place;
    }
    const Field *field = &p->fields[best];
    int32_t values = (best + 1 < p->n_fields ? p->fields[best + 1].offset : p->n_facts) - field->offset;
    if (!ints_push(tree, best)) return NONE;
    for (int32_t v = 0; v <= values; v++)
        if (!ints_push(tree, NONE)) return NONE;
    int32_t *part = malloc(((size_t)count + 1) * sizeof *part);
    if (!part) return NONE;
    done[best] = 1;
    for (int32_t v = 0; v <= values; v++) {
        int32_t chosen = 0;
        for (int32_t i = 0; i < count; i++) {
            size_t row = (size_t)ops[i] * p->words;
            int asks = mentions(p->need_mask + row, field);
            if (v == values ? !asks : asks && code(p->need + row, field) == (uint64_t)v) part[chosen++] = ops[i];
        }
        if (chosen) {
            int32_t child = plant(p, part, chosen, done);
            if (child == NONE) {
                free(part);
                return NONE;
            }
            tree->at[place + 1 + v] = child;
        }
    }
    done[best] = 0;
    free(part);
    return place;
}

static void climb(const Problem *p, const Word *state, int32_t place, Ints *found) {
    while (place != NONE) {
        const int32_t *node = p->tree.at + place;
        if (node[0] == NONE) {
            for (int32_t i = 0; i < node[1]; i++) {
                int32_t op = node[2 + i];
                int fits = 1;
                for (int32_t j = p->forbids.start[op]; fits && j < p->forbids.start[op + 1]; j++) {
                    const Word *rows = p->forbidden + 2 * (size_t)p->forbids.at[j] * p->words;
                    fits = !matches(state, rows, rows + p->words, p->words);
                }
                if (fits) found->at[found->count++] = op;
            }
            return;
        }
        const Field *field = &p->fields[node[0]];
        int32_t values = (node[0] + 1 < p->n_fields ? p->fields[node[0] + 1].offset : p->n_facts) - field->offset;
        uint64_t value = code(state, field);
        if (value < (uint64_t)values && node[1 + value] != NONE) climb(p, state, node[1 + value], found);
        place = node[1 + values];
    }
}

/* The tree for all operators; whether there was memory for it. */
static int plant_all(Problem *p) {
    if (!p->n_ops) return 1;
    Ints ops = {0};
    char *done = calloc((size_t)p->n_fields + 1, 1);
    int fine = done != NULL;
    for (int32_t o = 0; fine && o < p->n_ops; o++) fine = ints_push(&ops, o);
    fine = fine && plant(p, ops.at, p->n_ops, done) != NONE;
    free(ops.at), free(done);
    return fine;
}

/* Applicable operators; `found` has room for all of them. */
static void successors(const Problem *p, const Word *state, Ints *found) {
    found->count = 0;
    if (p->n_ops) climb(p, state, 0, found);
}
