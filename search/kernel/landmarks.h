/* Landmarks that LM-cut has found of states, kept for the states after them: those that an operator is not in hold after it.

   Each is kept once, and the sets of them that hold in states are, in a ring, so that the oldest are overwritten once it
   is as large as may be.  Source: Pommerening and Helmert, Incremental LM-cut (2013). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "state_table.h"
#include "values.h"

/* How many numbers of one state are kept at most; how many of landmarks, and of sets, at a time. */
#ifndef LONGEST
#define LONGEST (1 << 16)
#define MOST_LANDMARKS (1 << 23)
#define MOST_SETS (1 << 23)
#endif

enum { LANDMARK = 4, SET = 4 };

typedef struct {
    Ints pool; /* of each landmark its hash, what it costs (two numbers), how many operators, and these */
    int32_t *slots;
    size_t n_slots, n_landmarks;
    int32_t *sets; /* of each how many landmarks, the turn that found it, where the state's set before it is (two numbers);
                      then the places of the landmarks */
    int64_t room, end; /* how many numbers there is room for; have ever been written, and where the next ones come */
    int64_t first;     /* sets before are forgotten */
} Landmarks;

static void landmarks_free(Landmarks *l) { free(l->pool.at), free(l->slots), free(l->sets); }

static int grow_numbers(int32_t **at, size_t before, size_t room, Table *t) {
    if (!allow(t, (room - before) * sizeof **at)) return 0;
    int32_t *larger = realloc(*at, room * sizeof **at);
    if (larger) *at = larger;
    else t->wanted = SIZE_MAX;
    return larger != NULL;
}

static int grow_slots(Landmarks *l, Table *t) {
    size_t count = l->n_slots ? 2 * l->n_slots : 1 << 14;
    if (!grow_numbers(&l->slots, l->n_slots, count, t)) return 0;
    memset(l->slots, 0xFF, count * sizeof *l->slots);
    l->n_slots = count;
    for (size_t place = 0; place < l->pool.count; place += LANDMARK + (size_t)l->pool.at[place + 3]) {
        size_t i = (uint32_t)l->pool.at[place] & (count - 1);
        while (l->slots[i] != NONE) i = (i + 1) & (count - 1);
        l->slots[i] = (int32_t)place;
    }
    return 1;
}

/* Room for what one state may bring, where that is not too much; whether it is there.  Once there are too many landmarks
   all are forgotten. */
static int landmarks_reserve(Landmarks *l, Table *t) {
    if (l->end + LONGEST > l->room && l->room < MOST_SETS) {
        size_t room = l->room ? 2 * (size_t)l->room : 4 * LONGEST;
        if (!grow_numbers(&l->sets, (size_t)l->room, room, t)) return 0;
        l->room = (int64_t)room;
    }
    if (l->pool.count + LONGEST > l->pool.room) {
        if (l->pool.room < MOST_LANDMARKS) {
            size_t room = l->pool.room ? 2 * l->pool.room : 4 * LONGEST;
            if (!grow_numbers(&l->pool.at, l->pool.room, room, t)) return 0;
            l->pool.room = room;
        } else {
            l->pool.count = l->n_landmarks = 0, l->first = l->end;
            memset(l->slots, 0xFF, l->n_slots * sizeof *l->slots);
        }
    }
    return 2 * l->n_landmarks < l->n_slots || grow_slots(l, t);
}

/* The place of a landmark; NONE: there is no room for it. */
static int32_t place_of(Landmarks *l, const int32_t *ops, int32_t count, Cost cost) {
    uint32_t h = 2166136261u ^ (uint32_t)cost ^ (uint32_t)(cost >> 32);
    for (int32_t i = 0; i < count; i++) h = (h ^ (uint32_t)ops[i]) * 16777619u;
    h ^= h >> 15;
    int32_t head[LANDMARK] = {(int32_t)h, (int32_t)(uint32_t)cost, (int32_t)(cost >> 32), count};
    size_t size = (size_t)count * sizeof *ops, i = h & (l->n_slots - 1);
    for (; l->slots[i] != NONE; i = (i + 1) & (l->n_slots - 1)) {
        const int32_t *at = l->pool.at + l->slots[i];
        if (!memcmp(at, head, sizeof head) && !memcmp(at + LANDMARK, ops, size)) return l->slots[i];
    }
    if (l->pool.count + LANDMARK + (size_t)count > l->pool.room || 4 * l->n_landmarks > 3 * l->n_slots) return NONE;
    int32_t *to = l->pool.at + l->pool.count;
    memcpy(to, head, sizeof head), memcpy(to + LANDMARK, ops, size);
    l->slots[i] = (int32_t)l->pool.count, l->n_landmarks++;
    l->pool.count += LANDMARK + (size_t)count;
    return l->slots[i];
}

static Cost cost_of(const int32_t *landmark) { return (Cost)((uint64_t)(uint32_t)landmark[2] << 32 | (uint32_t)landmark[1]); }

/* Keep a set of a state that has others at `before`, or NONE; where it is. */
static int64_t keep_set(Landmarks *l, const Ints *found, int32_t turn, int64_t before) {
    int64_t count = (int64_t)found->count + SET;
    if (count > LONGEST) return before;
    if (l->end % l->room + count > l->room) l->end += l->room - l->end % l->room;
    int64_t place = l->end;
    int32_t *to = l->sets + place % l->room;
    to[0] = (int32_t)found->count, to[1] = turn;
    memcpy(to + 2, &before, sizeof before);
    if (found->count) memcpy(to + SET, found->at, found->count * sizeof *to);
    l->end += count;
    return place;
}

/* Of the sets of a state, the last of which is at a place, the one of a turn, else the last; NULL where none is left. */
static const int32_t *set_of(const Landmarks *l, int64_t place, int32_t turn) {
    const int32_t *last = NULL;
    while (place >= l->first && l->end - place <= l->room) {
        const int32_t *set = l->sets + place % l->room;
        if (set[1] == turn) return set;
        if (!last) last = set;
        memcpy(&place, set + 2, sizeof place);
    }
    return last;
}
