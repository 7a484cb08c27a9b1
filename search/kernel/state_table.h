/* The state table: each state that was met has a number and a node, and is found again by hashing.

   It holds the account of memory of its search, too: nothing is allocated that was not allowed for, and states and open
   lists count together.  States and nodes never move. */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "heap.h"
#include "lists.h"
#include "values.h"

enum { CHUNK_BITS = 12, CHUNK = 1 << CHUNK_BITS };

typedef struct {
    Cost spent, rest; /* spent in the search `stamp`; rest: no plan from here is cheaper */
    Cost at_once;     /* of epochs: no way that leaves something behind at once is cheaper from here */
    int64_t landmarks; /* where its last set is, or NONE, see landmarks.h */
    int32_t parent, op;
    uint32_t stamp;
    uint8_t exact, evaluated, closed;
    uint8_t renamed; /* whether it stands for what `op` makes of the parent, see like_fields.h */
} Node;

typedef struct {
    int32_t words, count;
    Word **states;
    Node **nodes;
    size_t chunks, chunk_room;
    int32_t *slots;
    size_t n_slots; /* a power of two */
    size_t allowed, wanted, used; /* bytes: may still be allocated; would have been; are */
} Table;

static Word *state_of(const Table *t, int32_t id) {
    return t->states[id >> CHUNK_BITS] + (size_t)(id & (CHUNK - 1)) * t->words;
}

static Node *node_of(const Table *t, int32_t id) { return &t->nodes[id >> CHUNK_BITS][id & (CHUNK - 1)]; }

static int is_same(const Word *a, const Word *b, int32_t words) {
    for (int32_t w = 0; w < words; w++)
        if (a[w] != b[w]) return 0;
    return 1;
}

static size_t hash(const Word *state, int32_t words) {
    Word h = 0x9E3779B97F4A7C15u;
    for (int32_t i = 0; i < words; i++) {
        h = (h ^ state[i]) * 0xBF58476D1CE4E5B9u;
        h ^= h >> 29;
    }
    h *= 0x94D049BB133111EBu;
    return (size_t)(h ^ (h >> 32));
}

static void grant(Table *t, size_t allowed) { t->allowed = allowed, t->wanted = 0; }

static int allow(Table *t, size_t size) {
    if (size > t->allowed) {
        t->wanted = size;
        return 0;
    }
    t->allowed -= size, t->used += size;
    return 1;
}

/* Whether `more` states may be added without further memory; makes room where it is allowed. */
static int reserve(Table *t, int32_t more) {
    while ((size_t)t->count + (size_t)more > t->chunks * CHUNK) {
        if (!allow(t, CHUNK * (sizeof(Node) + (size_t)t->words * sizeof(Word)))) return 0;
        if (t->chunks == t->chunk_room) {
            size_t room = t->chunk_room ? 2 * t->chunk_room : 16;
            Word **states = realloc(t->states, room * sizeof *states);
            if (!states) return 0;
            t->states = states;
            Node **nodes = realloc(t->nodes, room * sizeof *nodes);
            if (!nodes) return 0;
            t->nodes = nodes, t->chunk_room = room;
        }
        Word *states = malloc(CHUNK * (size_t)t->words * sizeof *states);
        Node *nodes = malloc(CHUNK * sizeof *nodes);
        if (!states || !nodes) {
            free(states), free(nodes);
            t->wanted = SIZE_MAX;
            return 0;
        }
        t->states[t->chunks] = states, t->nodes[t->chunks++] = nodes;
    }
    if (2 * ((size_t)t->count + (size_t)more) > t->n_slots) {
        size_t slots = t->n_slots ? t->n_slots : 1024;
        while (2 * ((size_t)t->count + (size_t)more) > slots) slots *= 2;
        if (!allow(t, slots * sizeof *t->slots)) return 0;
        int32_t *at = malloc(slots * sizeof *at);
        if (!at) {
            t->wanted = SIZE_MAX;
            return 0;
        }
        memset(at, 0xFF, slots * sizeof *at);
        for (int32_t id = 0; id < t->count; id++) {
            size_t i = hash(state_of(t, id), t->words) & (slots - 1);
            while (at[i] != NONE) i = (i + 1) & (slots - 1);
            at[i] = id;
        }
        t->used -= t->n_slots * sizeof *at, t->allowed += t->n_slots * sizeof *at;
        free(t->slots);
        t->slots = at, t->n_slots = slots;
    }
    return 1;
}

/* Room for more entries; it counts with the states. */
static int heap_reserve(Heap *heap, size_t more, Table *t) {
    if (heap->count + more <= heap->room) return 1;
    size_t room = heap->count + more + heap->room / 2;
    if (!allow(t, (room - heap->room) * sizeof *heap->at)) return 0;
    Entry *at = realloc(heap->at, room * sizeof *at);
    if (!at) {
        t->wanted = SIZE_MAX;
        return 0;
    }
    heap->at = at, heap->room = room;
    return 1;
}

/* The number of a state that was met, or NONE. */
static int32_t met(const Table *t, const Word *state) {
    if (!t->n_slots) return NONE;
    for (size_t i = hash(state, t->words) & (t->n_slots - 1); t->slots[i] != NONE; i = (i + 1) & (t->n_slots - 1))
        if (is_same(state_of(t, t->slots[i]), state, t->words)) return t->slots[i];
    return NONE;
}

/* The number of a state, which is added where it is new; there is room for one more. */
static int32_t find(Table *t, const Word *state, int *is_new) {
    size_t i = hash(state, t->words) & (t->n_slots - 1);
    for (; t->slots[i] != NONE; i = (i + 1) & (t->n_slots - 1))
        if (is_same(state_of(t, t->slots[i]), state, t->words)) {
            if (is_new) *is_new = 0;
            return t->slots[i];
        }
    int32_t id = t->count++;
    t->slots[i] = id;
    memcpy(state_of(t, id), state, (size_t)t->words * sizeof *state);
    *node_of(t, id) = (Node){.landmarks = NONE, .parent = NONE, .op = NONE};
    if (is_new) *is_new = 1;
    return id;
}

/* Operators along the parents of a node, and on from there, if `rest` is there; whether there was memory for them. */
static int way_to(const Table *t, int32_t id, const Ints *rest, Ints *way) {
    way->count = 0;
    for (; node_of(t, id)->parent != NONE; id = node_of(t, id)->parent)
        if (!ints_push(way, node_of(t, id)->op)) return 0;
    for (size_t i = 0, j = way->count; i + 1 < j; i++) {
        int32_t op = way->at[i];
        way->at[i] = way->at[--j], way->at[j] = op;
    }
    for (size_t i = 0; rest && i < rest->count; i++)
        if (!ints_push(way, rest->at[i])) return 0;
    return 1;
}

/* Forget all states, and keep the memory. */
static void table_clear(Table *t) {
    t->count = 0, t->wanted = 0;
    if (t->slots) memset(t->slots, 0xFF, t->n_slots * sizeof *t->slots);
}

static void table_free(Table *t) {
    for (size_t i = 0; i < t->chunks; i++) free(t->states[i]), free(t->nodes[i]);
    free(t->states), free(t->nodes), free(t->slots);
}
