/* Intended effects: an operator of an optimal plan adds something that a later one asks for, or that the goal asks for;
   else the plan would do without it.  Nor does it go on with one where a single operator would do for both, or none.

   Source: Karpas and Domshlak, Optimal search with inadmissible heuristics (2012). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_problem.h"
#include "values.h"

enum { UNKNOWN = -2, MOST_USERS = 1 << 20 };

typedef struct {
    int enabled;    /* no operator asks for what must not hold */
    int32_t *users; /* per operator the place of its list; UNKNOWN: not looked for; NONE: the goal asks for what it adds */
    Ints pool;      /* lists: a hash, a count, relaxed operators, ascending, then ~f for fields f that are only set where asked for */
    Ints slots, found;
    int32_t n_lists;
    int32_t *like; /* operators by what they ask for */
    size_t n_like;
    Word *set, *blind, *row; /* fields that an operator changes; that some set without asking for them */
    Ints usable, reached;    /* users that come before anything else is done to what they use */
    int32_t *missing;        /* per relaxed operator how much it asks for that is not reached */
    uint8_t *got;            /* facts that are reached */
} Intentions;

static void intentions_free(Intentions *n) {
    free(n->users), free(n->pool.at), free(n->slots.at), free(n->found.at), free(n->like);
    free(n->set), free(n->blind), free(n->row), free(n->usable.at), free(n->reached.at), free(n->missing), free(n->got);
}

static size_t asks_hash(const Problem *p, const Word *mask, const Word *need) {
    Word h = 0x9E3779B97F4A7C15u;
    for (int32_t w = 0; w < p->words; w++) h = ((h ^ mask[w]) * 0xBF58476D1CE4E5B9u ^ need[w]) * 0x94D049BB133111EBu, h ^= h >> 31;
    return (size_t)h;
}

static int intentions_new(Intentions *n, const Problem *p, const RelaxedProblem *x) {
    n->enabled = !p->n_forbidden && !p->n_goal_forbidden;
    if (!n->enabled) return 1;
    size_t row = (size_t)p->words, ops = (size_t)p->n_ops;
    for (n->n_like = 64; n->n_like < 2 * ops;) n->n_like *= 2;
    n->users = malloc((ops + 1) * sizeof(int32_t)), n->like = malloc(n->n_like * sizeof(int32_t));
    n->set = malloc(row * sizeof(Word)), n->row = malloc(2 * row * sizeof(Word)), n->blind = calloc(row, sizeof(Word));
    n->usable.at = malloc(((size_t)x->n_ops + 1) * sizeof(int32_t)), n->reached.at = malloc(((size_t)x->n_facts + 1) * sizeof(int32_t));
    n->missing = malloc(((size_t)x->n_ops + 1) * sizeof(int32_t)), n->got = malloc((size_t)x->n_facts + 1);
    if (!(n->users && n->like && n->set && n->row && n->blind && n->usable.at && n->reached.at && n->missing && n->got)) return 0;
    memset(n->like, 0xFF, n->n_like * sizeof(int32_t));
    for (size_t o = 0; o < ops; o++) {
        n->users[o] = UNKNOWN;
        for (size_t w = 0; w < row; w++) n->blind[w] |= ~p->keep[o * row + w] & ~p->need_mask[o * row + w];
        size_t i = asks_hash(p, p->need_mask + o * row, p->need + o * row) & (n->n_like - 1);
        while (n->like[i] != NONE) i = (i + 1) & (n->n_like - 1);
        n->like[i] = (int32_t)o;
    }
    return 1;
}

/* The fields that an operator changes, whatever the state; how many, or NONE where it does not ask for one of them. */
static int32_t changed(const Intentions *n, const Problem *p, int32_t op) {
    size_t row = (size_t)op * p->words;
    int32_t count = 0;
    memset(n->set, 0, (size_t)p->words * sizeof(Word));
    for (int32_t f = 0; f < p->n_fields; f++) {
        const Field *field = &p->fields[f];
        if (code(p->keep + row, field) == ((uint64_t)1 << field->width) - 1) continue;
        if (!mentions(p->need_mask + row, field)) return NONE;
        if (code(p->need + row, field) == code(p->put + row, field)) continue;
        count++;
        for (int32_t b = field->shift; b < field->shift + field->width; b++) n->set[b >> 6] |= (Word)1 << (b & 63);
    }
    return count;
}

/* Whether two operators in turn do nothing, or what a cheaper one does, where those between them have nothing to do with
   what the first one sets. */
static int has_shortcut(const Intentions *n, const Problem *p, int32_t a, int32_t b) {
    size_t words = (size_t)p->words, x = (size_t)a * words, y = (size_t)b * words;
    Word *mask = n->row, *need = n->row + words;
    int undone = 1;
    for (size_t w = 0; w < words; w++) {
        Word set = n->set[w], put = (p->put[x + w] & p->keep[y + w]) | p->put[y + w];
        mask[w] = (p->need_mask[y + w] & ~set) | (p->need_mask[x + w] & set);
        need[w] = (p->need[y + w] & ~set) | (p->need[x + w] & set);
        if ((put ^ p->need[x + w]) & set || (~p->keep[y + w] & ~set & (p->put[y + w] ^ p->need[y + w])) ||
            (~p->keep[y + w] & ~set & ~p->need_mask[y + w]))
            undone = 0;
    }
    if (undone) return 1;
    for (size_t i = asks_hash(p, mask, need) & (n->n_like - 1); n->like[i] != NONE; i = (i + 1) & (n->n_like - 1)) {
        int32_t c = n->like[i];
        size_t z = (size_t)c * words;
        if (p->weight[c] >= p->weight[a] + p->weight[b]) continue;
        int same = 1;
        for (size_t w = 0; same && w < words; w++) {
            Word set = n->set[w], put = (p->put[x + w] & p->keep[y + w]) | p->put[y + w];
            same = p->need_mask[z + w] == mask[w] && p->need[z + w] == need[w] &&
                   !((((need[w] & p->keep[z + w]) | p->put[z + w]) ^ put) & set) &&
                   !((p->keep[z + w] ^ p->keep[y + w]) & ~set) && !((p->put[z + w] ^ p->put[y + w]) & ~set);
        }
        if (same) return 1;
    }
    return 0;
}

/* The place of a list that is in the pool, or is added to it. */
static int32_t pooled(Intentions *n) {
    size_t count = n->found.count;
    if (n->slots.count < 2 * ((size_t)n->n_lists + 1)) {
        size_t room = n->slots.count ? 2 * n->slots.count : 256;
        int32_t *at = malloc(room * sizeof *at);
        if (!at) return NONE;
        memset(at, 0xFF, room * sizeof *at);
        for (size_t old = 0; old < n->slots.count; old++) {
            int32_t place = n->slots.at[old];
            if (place == NONE) continue;
            size_t i = (uint32_t)n->pool.at[place] & (room - 1);
            while (at[i] != NONE) i = (i + 1) & (room - 1);
            at[i] = place;
        }
        free(n->slots.at);
        n->slots.at = at, n->slots.count = room;
    }
    uint32_t h = 2166136261u;
    for (size_t i = 0; i < count; i++) h = (h ^ (uint32_t)n->found.at[i]) * 16777619u;
    h ^= h >> 15;
    size_t i = h & (n->slots.count - 1);
    for (; n->slots.at[i] != NONE; i = (i + 1) & (n->slots.count - 1)) {
        const int32_t *list = n->pool.at + n->slots.at[i];
        if ((uint32_t)list[0] == h && (size_t)list[1] == count && !memcmp(list + 2, n->found.at, count * sizeof *list))
            return n->slots.at[i];
    }
    int32_t place = (int32_t)n->pool.count;
    if (!ints_push(&n->pool, (int32_t)h) || !ints_push(&n->pool, (int32_t)count)) return NONE;
    for (size_t j = 0; j < count; j++)
        if (!ints_push(&n->pool, n->found.at[j])) return NONE;
    n->slots.at[i] = place, n->n_lists++;
    return place;
}

static int by_number(const void *a, const void *b) { return *(const int32_t *)a - *(const int32_t *)b; }

/* Operators of which an optimal plan needs one after this one: the place of their list, or NONE. */
static int32_t find_users(Intentions *n, const Problem *p, const RelaxedProblem *x, int32_t op) {
    int32_t class = x->class_of[op];
    n->found.count = 0;
    if (class == NONE) return pooled(n);
    for (int32_t j = x->add.start[class]; j < x->add.start[class + 1]; j++)
        for (size_t g = 0; g < x->goal.count; g++)
            if (x->goal.at[g] == x->add.at[j]) return NONE;
    if (n->pool.count > MOST_USERS) return NONE;
    int32_t fields = changed(n, p, op);
    int is_kept = fields > 0; /* until somebody asks for it */
    for (int32_t w = 0; w < p->words; w++)
        if (n->set[w] & n->blind[w]) is_kept = 0;
    for (int32_t j = x->add.start[class]; j < x->add.start[class + 1]; j++)
        for (int32_t k = x->asked_by.start[x->add.at[j]]; k < x->asked_by.start[x->add.at[j] + 1]; k++) {
            int32_t user = x->asked_by.at[k], uses = !is_kept;
            for (int32_t m = x->members.start[user]; !uses && m < x->members.start[user + 1]; m++)
                uses = !has_shortcut(n, p, op, x->members.at[m]);
            if (uses && !ints_push(&n->found, user)) return NONE;
        }
    if (n->found.count > 1) qsort(n->found.at, n->found.count, sizeof(int32_t), by_number);
    size_t left = 0;
    for (size_t i = 0; i < n->found.count; i++)
        if (!left || n->found.at[left - 1] != n->found.at[i]) n->found.at[left++] = n->found.at[i];
    n->found.count = left;
    for (int32_t f = 0; is_kept && f < p->n_fields; f++)
        if (mentions(n->set, &p->fields[f]) && !ints_push(&n->found, ~f)) return NONE;
    return pooled(n);
}

static int32_t users_of(Intentions *n, const Problem *p, const RelaxedProblem *x, int32_t op) {
    if (!n->enabled) return NONE;
    if (n->users[op] == UNKNOWN) n->users[op] = find_users(n, p, x, op);
    return n->users[op];
}

static int32_t fact_in(const Problem *p, const RelaxedProblem *x, const Word *state, int32_t f) {
    return x->fact_of[p->fields[f].offset + (int32_t)code(state, &p->fields[f])];
}

static void get(Intentions *n, int32_t fact) {
    if (fact == NONE || n->got[fact]) return;
    n->got[fact] = 1;
    put(&n->reached, fact);
}

/* Of the users of an operator, which has led to a state, those that can come before anything else asks for what it sets:
   what comes before them is reached without that. */
static void find_usable(Intentions *n, const Problem *p, const RelaxedProblem *x, const Word *state, int32_t place) {
    const int32_t *list = n->pool.at + place + 2, *end = list + list[-1], *kept = list;
    n->usable.count = 0;
    while (kept < end && *kept >= 0) put(&n->usable, *kept++);
    if (kept == end) return;
    memset(n->got, 0, (size_t)x->n_facts);
    n->reached.count = 0;
    for (int32_t o = 0; o < x->n_ops; o++) n->missing[o] = x->pre.start[o + 1] - x->pre.start[o];
    const int32_t *next = kept;
    for (int32_t f = 0; f < p->n_fields; f++)
        if (next < end && *next == ~f) next++;
        else get(n, fact_in(p, x, state, f));
    for (size_t i = 0; i < x->always.count; i++)
        for (int32_t j = x->add.start[x->always.at[i]]; j < x->add.start[x->always.at[i] + 1]; j++) get(n, x->add.at[j]);
    for (size_t i = 0; i < n->reached.count; i++) {
        int32_t fact = n->reached.at[i];
        for (int32_t k = x->asked_by.start[fact]; k < x->asked_by.start[fact + 1]; k++) {
            int32_t o = x->asked_by.at[k];
            if (--n->missing[o]) continue;
            for (int32_t j = x->add.start[o]; j < x->add.start[o + 1]; j++) get(n, x->add.at[j]);
        }
    }
    for (; kept < end; kept++) get(n, fact_in(p, x, state, ~*kept));
    size_t left = 0;
    for (size_t k = 0; k < n->usable.count; k++) {
        int32_t user = n->usable.at[k];
        int comes = 1;
        for (int32_t j = x->pre.start[user]; comes && j < x->pre.start[user + 1]; j++) comes = n->got[x->pre.at[j]];
        if (comes) n->usable.at[left++] = user;
    }
    n->usable.count = left;
}

/* What an optimal plan still costs from a state after an operator that has led to it, where landmarks that cost `total`
   have left other operators what they cost now. */
static Cost with_intention(Intentions *n, const Problem *p, const Relaxation *r, int32_t op, const Word *state, Cost total) {
    int32_t place = users_of(n, p, &r->problem, op);
    if (place < 0 || total == INFINITE_COST) return total;
    find_usable(n, p, &r->problem, state, place);
    Cost least = INFINITE_COST;
    for (size_t k = 0; k < n->usable.count; k++) {
        const RelaxedOp *user = &r->ops[n->usable.at[k]];
        if (user->unsatisfied || user->cost >= least) continue;
        least = user->cost;
        if (!least) return total;
    }
    return least == INFINITE_COST ? INFINITE_COST : total + least;
}
