/* Saturated cost partitioning: an admissible bound from projections whose distances add up.

   In an order, each takes of the operators' costs what its distances need, and leaves the rest to the next.  Orders
   are made greedily for sampled states, and kept where they say more of some sample than those before.

   Source: Seipp, Keller and Helmert, Saturated cost partitioning for optimal classical planning (2020). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "heap.h"
#include "lists.h"
#include "problem.h"
#include "projection.h"
#include "values.h"

/* A projection that may take all of the costs: its distances, and how much it takes. */
typedef struct {
    Cost *cost;
    double taken;
} Alone;

typedef struct {
    Projection *at;
    Alone *alone;
    int32_t count, room, n_orders, n_samples;
    Cost **tables; /* n_orders times count; NULL where all is 0 */
    Word *samples;
    Cost *best; /* what is said of each sample */
    Cost *left, *needed, *steps, *found;
    int64_t *codes, *number; /* of the state that is asked about: of each field; in each projection, -1: not known */
    Heap heap;
} Projections;

/* Distances to the goal in a projection, under weights of the operators. */
static int distances(Projections *all, const Projection *b, const Cost *weights, Cost *found) {
    for (int32_t c = 0; c < b->n_classes; c++) {
        Cost least = INFINITE_COST;
        for (int32_t j = b->members.start[c]; j < b->members.start[c + 1]; j++)
            if (weights[b->members.at[j]] < least) least = weights[b->members.at[j]];
        all->steps[c] = least;
    }
    all->heap.count = 0;
    for (int32_t i = 0; i < b->n_states; i++) {
        found[i] = b->goals[i] ? 0 : INFINITE_COST;
        if (b->goals[i] && b->first[i + 1] > b->first[i] && !heap_push(&all->heap, (Entry){0, 0, i, 0})) return 0;
    }
    while (all->heap.count) {
        Entry entry = heap_pop(&all->heap);
        if (entry.key > found[entry.item]) continue;
        for (int32_t j = b->first[entry.item]; j < b->first[entry.item + 1]; j++) {
            Cost cost = plus(entry.key, all->steps[b->class[j]]);
            if (cost >= found[b->source[j]]) continue;
            found[b->source[j]] = cost;
            if (!heap_push(&all->heap, (Entry){cost, 0, b->source[j], 0})) return 0;
        }
    }
    return 1;
}

/* Per operator the least weight with which the distances stay what they are. */
static void saturate(Projections *all, const Projection *b, const Cost *found, Cost *needed, int32_t n_ops) {
    memset(needed, 0, (size_t)n_ops * sizeof *needed);
    memset(all->steps, 0, (size_t)b->n_classes * sizeof *all->steps);
    for (int32_t to = 0; to < b->n_states; to++) {
        if (found[to] == INFINITE_COST) continue;
        for (int32_t j = b->first[to]; j < b->first[to + 1]; j++) {
            Cost drop = found[b->source[j]] - found[to];
            if (drop > all->steps[b->class[j]] && found[b->source[j]] != INFINITE_COST) all->steps[b->class[j]] = drop;
        }
    }
    for (int32_t c = 0; c < b->n_classes; c++)
        for (int32_t j = b->members.start[c]; j < b->members.start[c + 1]; j++) needed[b->members.at[j]] = all->steps[c];
}

/* Tables of one order, best first for a state: each takes what it needs of the weights and leaves the rest. */
static int partition(Projections *all, const Problem *p, const Word *state, Cost **tables) {
    int32_t *order = malloc(((size_t)all->count + 1) * sizeof *order);
    double *worth = malloc(((size_t)all->count + 1) * sizeof *worth);
    int fine = order && worth;
    for (int32_t i = 0; fine && i < all->count; i++) {
        double value = (double)all->alone[i].cost[number_of(p, &all->at[i], state)] / (all->alone[i].taken + 1);
        int32_t j = i;
        for (; j > 0 && worth[j - 1] < value; j--) worth[j] = worth[j - 1], order[j] = order[j - 1];
        worth[j] = value, order[j] = i;
    }
    memcpy(all->left, p->weight, (size_t)p->n_ops * sizeof(Cost));
    for (int32_t i = 0; fine && i < all->count; i++) {
        const Projection *b = &all->at[order[i]];
        Cost most = 0;
        fine = distances(all, b, all->left, all->found);
        for (int32_t j = 0; j < b->n_states; j++) most = all->found[j] > most ? all->found[j] : most;
        if (!fine || !most) continue;
        saturate(all, b, all->found, all->needed, p->n_ops);
        for (int32_t o = 0; o < p->n_ops; o++) all->left[o] -= all->needed[o];
        fine = (tables[order[i]] = copied(all->found, (size_t)b->n_states * sizeof(Cost))) != NULL;
    }
    free(order), free(worth);
    return fine;
}

/* The number of a state in a projection, from its codes, once. */
static inline int64_t number_in(const Projections *all, int32_t projection) {
    int64_t number = all->number[projection];
    if (number >= 0) return number;
    const Projection *b = &all->at[projection];
    number = 0;
    for (size_t i = 0; i < b->fields.count; i++) number += all->codes[b->fields.at[i]] * b->strides[i];
    return all->number[projection] = number;
}

/* The state that is asked about from now on. */
static void ask_about(const Projections *all, const Problem *p, const Word *state) {
    for (int32_t f = 0; f < p->n_fields; f++) all->codes[f] = (int64_t)code(state, &p->fields[f]);
    memset(all->number, 0xFF, (size_t)all->count * sizeof *all->number);
}

/* What tables say of it. */
static Cost summed(const Projections *all, Cost *const *tables) {
    Cost sum = 0;
    for (int32_t i = 0; i < all->count; i++) {
        if (!tables[i]) continue;
        Cost value = tables[i][number_in(all, i)];
        if (value == INFINITE_COST) return value;
        sum = plus(sum, value);
    }
    return sum;
}

/* What they say of a state, or of what they say something that is enough. */
static Cost projected(const Projections *all, const Problem *p, const Word *state, Cost enough) {
    ask_about(all, p, state);
    Cost best = 0;
    for (int32_t order = 0; order < all->n_orders && best < enough; order++) {
        Cost sum = summed(all, all->tables + (size_t)order * all->count);
        if (sum > best) best = sum;
    }
    return best;
}

static void projections_free(Projections *all) {
    for (int32_t i = 0; i < all->count * all->n_orders; i++) free(all->tables[i]);
    for (int32_t i = 0; i < all->count; i++) projection_free(&all->at[i]), free(all->alone[i].cost);
    free(all->at), free(all->alone), free(all->tables), free(all->samples), free(all->best), free(all->codes), free(all->number);
    free(all->left), free(all->needed), free(all->steps), free(all->found), free(all->heap.at);
}

/* Room for one more projection, and for what is worked with. */
static int projections_reserve(Projections *all, const Problem *p) {
    size_t ops = (size_t)p->n_ops + 1;
    if (!all->left) all->left = malloc(ops * sizeof(Cost));
    if (!all->needed) all->needed = malloc(ops * sizeof(Cost));
    if (!all->steps) all->steps = malloc(ops * sizeof(Cost));
    if (!all->left || !all->needed || !all->steps) return 0;
    if (all->count < all->room) return 1;
    int32_t room = all->room ? 2 * all->room : 16;
    Projection *at = realloc(all->at, (size_t)room * sizeof *at);
    if (at) all->at = at;
    Alone *alone = realloc(all->alone, (size_t)room * sizeof *alone);
    if (alone) all->alone = alone;
    if (at && alone) all->room = room;
    return at && alone;
}

/* Another pattern, given by the numbers of its fields, ascending: how many transitions it has; -1 where there are more
   than allowed, or memory is missing.  Not once there is an order. */
static int64_t projections_add(Projections *all, const Problem *p, const int32_t *fields, int32_t count, int64_t most_transitions) {
    if (!projections_reserve(all, p)) return -1;
    Projection *b = &all->at[all->count];
    if (!projection_new(b, p, fields, count, most_transitions)) return -1;
    Cost *cost = malloc((size_t)b->n_states * sizeof *cost);
    if (!cost || !distances(all, b, p->weight, cost)) {
        projection_free(b), free(cost);
        return -1;
    }
    saturate(all, b, cost, all->needed, p->n_ops);
    double taken = 0;
    for (int32_t o = 0; o < p->n_ops; o++) taken += (double)all->needed[o];
    all->alone[all->count++] = (Alone){cost, taken};
    return b->first[b->n_states];
}

/* Room for so many samples, which are then written to `samples`, a row each. */
static int samples_new(Projections *all, const Problem *p, int32_t count) {
    int32_t states = 1;
    for (int32_t i = 0; i < all->count; i++) states = all->at[i].n_states > states ? all->at[i].n_states : states;
    all->n_samples = count;
    all->samples = malloc(((size_t)count + 1) * (size_t)p->words * sizeof(Word));
    all->best = malloc(((size_t)count + 1) * sizeof(Cost));
    all->found = malloc((size_t)states * sizeof(Cost));
    all->number = malloc(((size_t)all->count + 1) * sizeof *all->number);
    all->codes = malloc(((size_t)p->n_fields + 1) * sizeof *all->codes);
    if (!all->samples || !all->best || !all->found || !all->codes || !all->number) return 0;
    for (int32_t i = 0; i < count; i++) all->best[i] = -1;
    return 1;
}

/* The order that is made for a sample: 1 where it says more of some sample than those before, and is kept; -1 where
   memory is missing. */
static int add_order(Projections *all, const Problem *p, int32_t sample) {
    size_t count = (size_t)all->count;
    Cost **tables = realloc(all->tables, ((size_t)all->n_orders + 1) * count * sizeof *tables);
    if (!tables) return -1;
    all->tables = tables;
    tables += (size_t)all->n_orders * count;
    memset(tables, 0, count * sizeof *tables);
    int better = 0, fine = partition(all, p, all->samples + (size_t)sample * p->words, tables);
    for (int32_t i = 0; fine && i < all->n_samples; i++) {
        const Word *state = all->samples + (size_t)i * p->words;
        ask_about(all, p, state);
        Cost value = summed(all, tables);
        if (value > all->best[i]) all->best[i] = value, better = 1;
    }
    if (better) {
        all->n_orders++;
        return 1;
    }
    for (size_t i = 0; i < count; i++) free(tables[i]);
    return fine ? 0 : -1;
}
