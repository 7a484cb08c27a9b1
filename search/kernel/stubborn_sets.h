/* Strong stubborn sets: of the applicable operators enough for some optimal plan to begin with one of them.

   Source: Wehrle and Helmert, Efficient stubborn sets: generalized algorithms and selection strategies (2014). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "problem.h"
#include "state_table.h"
#include "values.h"

enum { MOST_STUBBORN_OPS = 1 << 14, STUBBORN_TRIALS = 10000 };

/* A literal that an operator or the goal asks for: the field has this value, or has it not. */
typedef struct {
    int32_t field, value, negated;
} Literal;

/* Which operators disturb each other, as bits, and which make a literal true. */
typedef struct {
    int32_t words; /* of a set of operators; 0: there are too many of them */
    Word **disturbs;
    Lists asked; /* per operator its literals, last those of the goal */
    Literal *literals;
    Lists makers; /* operators that make a literal true */
    Word *set;
    uint32_t *added, round; /* of the literals whose makers are in the set */
    Ints waiting;
    int64_t kept, pruned;
} Stubborn;

static void stubborn_free(Stubborn *b, int32_t n_ops) {
    if (b->disturbs)
        for (int32_t o = 0; o < n_ops; o++) free(b->disturbs[o]);
    free(b->disturbs), free(b->literals), free(b->set), free(b->added), free(b->waiting.at);
    lists_free(&b->asked), lists_free(&b->makers);
}

static int holds(const Problem *p, const Word *state, const Literal *literal) {
    return (code(state, &p->fields[literal->field]) == (uint64_t)literal->value) != literal->negated;
}

/* The value that an operator gives a field, or NONE. */
static int32_t made(const Problem *p, int32_t op, int32_t f) {
    const Field *field = &p->fields[f];
    size_t row = (size_t)op * p->words;
    return code(p->keep + row, field) == ((uint64_t)1 << field->width) - 1 ? NONE : (int32_t)code(p->put + row, field);
}

static int list_literals(const Problem *p, int32_t owner, const Word *mask, const Word *value, Ints *which, Ints *what) {
    for (int32_t f = 0; f < p->n_fields; f++)
        if (mentions(mask, &p->fields[f])) {
            int32_t fact = p->fields[f].offset + (int32_t)code(value, &p->fields[f]);
            if (!ints_push(which, owner) || !ints_push(what, 2 * fact)) return 0;
        }
    return 1;
}

/* A literal that must not hold is one about one field. */
static int list_forbidden(const Problem *p, int32_t owner, const Word *rows, Ints *which, Ints *what) {
    Ints positive = {0}, unused = {0};
    int fine = list_literals(p, owner, rows, rows + p->words, &unused, &positive) && positive.count == 1 &&
               ints_push(which, owner) && ints_push(what, positive.at[0] + 1);
    free(positive.at), free(unused.at);
    return fine;
}

static int stubborn_new(Stubborn *b, const Problem *p) {
    if (p->n_ops > MOST_STUBBORN_OPS || !p->n_ops) return 1;
    Ints which = {0}, what = {0}, literal = {0}, maker = {0};
    int fine = 1;
    for (int32_t o = 0; fine && o < p->n_ops; o++) {
        size_t row = (size_t)o * p->words;
        fine = list_literals(p, o, p->need_mask + row, p->need + row, &which, &what);
        for (int32_t j = p->forbids.start[o]; fine && j < p->forbids.start[o + 1]; j++)
            fine = list_forbidden(p, o, p->forbidden + 2 * (size_t)p->forbids.at[j] * p->words, &which, &what);
    }
    fine = fine && list_literals(p, p->n_ops, p->goal_mask, p->goal, &which, &what);
    for (int32_t i = 0; fine && i < p->n_goal_forbidden; i++)
        fine = list_forbidden(p, p->n_ops, p->goal_forbidden + 2 * (size_t)i * p->words, &which, &what);
    int32_t n_literals = 2 * p->n_facts;
    b->literals = malloc(((size_t)n_literals + 1) * sizeof *b->literals);
    b->added = calloc((size_t)n_literals + 1, sizeof *b->added);
    char *used = calloc((size_t)n_literals + 1, 1);
    fine = fine && b->literals && b->added && used;
    for (size_t i = 0; fine && i < what.count; i++) used[what.at[i]] = 1;
    for (int32_t f = 0; fine && f < p->n_fields; f++) {
        int32_t end = f + 1 < p->n_fields ? p->fields[f + 1].offset : p->n_facts;
        for (int32_t fact = p->fields[f].offset; fact < end; fact++)
            for (int32_t negated = 0; negated < 2; negated++)
                b->literals[2 * fact + negated] = (Literal){f, fact - p->fields[f].offset, negated};
        for (int32_t o = 0; fine && o < p->n_ops; o++) {
            int32_t value = made(p, o, f);
            if (value == NONE) continue;
            for (int32_t fact = p->fields[f].offset; fine && fact < end; fact++)
                for (int32_t negated = 0; fine && negated < 2; negated++)
                    if (used[2 * fact + negated] && (fact == p->fields[f].offset + value) != negated)
                        fine = ints_push(&literal, 2 * fact + negated) && ints_push(&maker, o);
        }
    }
    fine = fine && lists_of(&b->asked, p->n_ops + 1, &which, &what) && lists_of(&b->makers, n_literals, &literal, &maker);
    free(which.at), free(what.at), free(literal.at), free(maker.at), free(used);
    b->disturbs = calloc((size_t)p->n_ops, sizeof *b->disturbs);
    b->waiting.at = malloc(((size_t)p->n_ops + 1) * sizeof(int32_t));
    int32_t words = (p->n_ops + 63) / 64;
    b->set = malloc((size_t)words * sizeof(Word));
    fine = fine && b->disturbs && b->waiting.at && b->set;
    if (fine) b->words = words;
    return fine;
}

/* Whether an operator makes one impossible, as far as what it makes goes. */
static int disables(const Problem *p, int32_t a, int32_t b) {
    size_t x = (size_t)a * p->words, y = (size_t)b * p->words;
    for (int32_t w = 0; w < p->words; w++)
        if (~p->keep[x + w] & p->need_mask[y + w] & (p->put[x + w] ^ p->need[y + w])) return 1;
    for (int32_t j = p->forbids.start[b]; j < p->forbids.start[b + 1]; j++) {
        const Word *mask = p->forbidden + 2 * (size_t)p->forbids.at[j] * p->words, *value = mask + p->words;
        int makes = 1;
        for (int32_t w = 0; makes && w < p->words; w++)
            makes = !(mask[w] & p->keep[x + w]) && (p->put[x + w] & mask[w]) == value[w];
        if (makes) return 1;
    }
    return 0;
}

/* Whether the order of two operators matters in some state that allows both. */
static int disturb(const Problem *p, int32_t a, int32_t b) {
    size_t x = (size_t)a * p->words, y = (size_t)b * p->words;
    Word differs = 0;
    for (int32_t w = 0; w < p->words; w++) {
        if (p->need_mask[x + w] & p->need_mask[y + w] & (p->need[x + w] ^ p->need[y + w])) return 0;
        differs |= ~p->keep[x + w] & ~p->keep[y + w] & (p->put[x + w] ^ p->put[y + w]);
    }
    return differs || disables(p, a, b) || disables(p, b, a);
}

static const Word *disturbed_by(Stubborn *b, const Problem *p, Table *t, int32_t op) {
    if (!b->disturbs[op]) {
        size_t size = (size_t)b->words * sizeof(Word);
        if (!allow(t, size) || !(b->disturbs[op] = calloc(1, size))) return NULL;
        for (int32_t o = 0; o < p->n_ops; o++)
            if (o != op && disturb(p, op, o)) b->disturbs[op][o >> 6] |= (Word)1 << (o & 63);
    }
    return b->disturbs[op];
}

static void include(Stubborn *b, int32_t op) {
    Word bit = (Word)1 << (op & 63);
    if (b->set[op >> 6] & bit) return;
    b->set[op >> 6] |= bit;
    put(&b->waiting, op);
}

/* Of what an operator (or the goal) asks for and what does not hold, what the fewest operators make true: these. */
static int include_makers(Stubborn *b, const Problem *p, const Word *state, int32_t owner) {
    int32_t best = NONE, least = INT32_MAX;
    for (int32_t j = b->asked.start[owner]; j < b->asked.start[owner + 1]; j++) {
        int32_t literal = b->asked.at[j];
        if (holds(p, state, &b->literals[literal])) continue;
        if (b->added[literal] == b->round) return 1;
        int32_t count = b->makers.start[literal + 1] - b->makers.start[literal];
        if (count < least) least = count, best = literal;
    }
    if (best == NONE) return 0;
    b->added[best] = b->round;
    for (int32_t j = b->makers.start[best]; j < b->makers.start[best + 1]; j++) include(b, b->makers.at[j]);
    return 1;
}

/* Leave of the applicable operators enough for some optimal plan to begin with one of them, where there is a plan: all
   costs are positive.  Where it seldom leaves out any it is given up. */
static void leave_stubborn(Stubborn *b, const Problem *p, Table *t, const Word *state, Ints *applicable) {
    if (left_out & STUBBORN_SETS || !b->words || applicable->count < 2) return;
    if (b->kept + b->pruned > STUBBORN_TRIALS && b->pruned * 10 < b->kept) return;
    memset(b->set, 0, (size_t)b->words * sizeof(Word));
    b->waiting.count = 0, b->round++;
    if (!include_makers(b, p, state, p->n_ops)) return;
    for (size_t i = 0; i < b->waiting.count; i++) {
        int32_t op = b->waiting.at[i];
        if (include_makers(b, p, state, op)) continue;
        const Word *others = disturbed_by(b, p, t, op);
        if (!others) return;
        for (int32_t w = 0; w < b->words; w++)
            for (Word fresh = others[w] & ~b->set[w]; fresh; fresh &= fresh - 1) include(b, 64 * w + __builtin_ctzll(fresh));
    }
    size_t left = 0;
    for (size_t i = 0; i < applicable->count; i++) {
        int32_t op = applicable->at[i];
        if (b->set[op >> 6] >> (op & 63) & 1) applicable->at[left++] = op;
    }
    b->kept += (int64_t)left, b->pruned += (int64_t)(applicable->count - left);
    applicable->count = left;
}
