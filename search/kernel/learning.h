/* What a finished search teaches about states, for searches from other states.

   Source: adaptive heuristics of Koenig and Likhachev, Adaptive A* (2005). */

#pragma once

#include <string.h>
#include "like_fields.h"
#include "lists.h"
#include "problem.h"
#include "state_table.h"
#include "values.h"

/* Of the states that were expanded: from none of them is a plan cheaper than total - spent. */
static void learn(Table *t, const Ints *closed, Cost total) {
    for (size_t i = 0; i < closed->count; i++) {
        Node *node = node_of(t, closed->at[i]);
        if (node->exact) continue;
        if (total == INFINITE_COST) {
            node->rest = INFINITE_COST, node->exact = 1;
        } else if (total - node->spent > node->rest) {
            node->rest = total - node->spent;
        }
    }
}

/* Along a cheapest plan: the exact costs.  There is room for its states; `state` is where it begins, `row` for another one. */
static void learn_plan(Table *t, const Problem *p, const Ints *alike, const Ints *plan, Cost total, Word *state, Word *row) {
    size_t size = (size_t)p->words * sizeof(Word);
    int is_new;
    for (size_t i = 0;; i++) {
        memcpy(row, state, size);
        represent(p, alike, row);
        Node *node = node_of(t, find(t, row, &is_new));
        node->rest = total, node->exact = 1;
        if (i == plan->count) return;
        apply(p, plan->at[i], state, row);
        memcpy(state, row, size);
        total -= p->weight[plan->at[i]];
    }
}
