/* What is done epoch by epoch for something that can be left behind, by the names that things really have: the states of
   layers stand for others. */

#pragma once

#include <string.h>
#include "epochs.h"
#include "problem.h"
#include "state_table.h"
#include "values.h"

/* The operators of an epoch that lead from `real`, which costs `spent`, to what a state stands for, at a cost, into `ops`; how
   many.  `real` becomes the state after them. */
static int32_t set_between(Epochs *e, Cost spent, int32_t given, const Word *target, Cost cost, int32_t *ops) {
    const size_t words = (size_t)e->problem.words;
    e->is_end = given == NONE, e->target = target, e->sought = cost, e->limit = INFINITE_COST, e->found = 0;
    from_state(e, e->real, spent, given);
    const Word *kept = e->kept + (size_t)e->found * words, *put = e->made + (size_t)e->found * words;
    for (size_t w = 0; w < words; w++) e->real[w] = (e->real[w] & kept[w]) | put[w];
    memcpy(ops, e->chosen, (size_t)e->found * sizeof *ops);
    return e->found;
}

/* What is done epoch by epoch for something that was left behind: each set ends with NONE. */
static int32_t epochs_way(Epochs *e, int32_t number, const int32_t *given, int32_t *ops) {
    const Leaving *leaving = &e->leavings[number];
    int32_t last = e->n_layers - 1, count = 0;
    e->way[last] = leaving->state;
    for (int32_t layer = last; layer; layer--) e->way[layer - 1] = node_of(&e->layers[layer], e->way[layer])->parent;
    memcpy(e->real, state_of(&e->layers[0], e->way[0]), (size_t)e->problem.words * sizeof(Word));
    Cost spent = node_of(&e->layers[0], e->way[0])->spent;
    for (int32_t layer = 1; layer <= last; layer++) {
        const Node *node = node_of(&e->layers[layer], e->way[layer]);
        e->alike_now = &e->alike[layer];
        count += set_between(e, spent, given[layer - 1], state_of(&e->layers[layer], e->way[layer]), node->spent, ops + count);
        ops[count++] = NONE, spent = node->spent;
    }
    count += set_between(e, spent, NONE, state_of(&e->ends, leaving->end), leaving->paid, ops + count);
    ops[count++] = NONE;
    return count;
}
