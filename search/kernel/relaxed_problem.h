/* The delete relaxation of the problem: no fact is ever lost.

   What nobody asks for is left out, and what must not be.  Operators that ask for and add the same facts are one, the
   cheapest of them. */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "problem.h"
#include "values.h"

typedef struct {
    int32_t n_ops, n_facts, n_slots;
    int32_t *fact_of, *class_of; /* of the problem's facts and operators; NONE: left out */
    Cost *weight;
    Lists pre, add, asked_by, added_by; /* operators' facts, facts' operators */
    Lists members;                      /* per operator those of the problem that it is */
    int32_t *adder;                     /* per place in add.at its operator */
    Ints goal, always;                  /* always: operators that ask for nothing */
} RelaxedProblem;

static void relaxed_problem_free(RelaxedProblem *x) {
    free(x->fact_of), free(x->class_of), free(x->weight), free(x->adder), free(x->goal.at), free(x->always.at);
    lists_free(&x->pre), lists_free(&x->add), lists_free(&x->asked_by), lists_free(&x->added_by), lists_free(&x->members);
}

static int32_t number_facts(RelaxedProblem *x, const Problem *p) {
    memset(x->fact_of, 0xFF, ((size_t)p->n_facts + 1) * sizeof *x->fact_of);
    int32_t count = 0;
    for (int32_t f = 0; f < p->n_fields; f++) {
        const Field *field = &p->fields[f];
        for (int32_t o = 0; o <= p->n_ops; o++) {
            const Word *mask = o < p->n_ops ? p->need_mask + (size_t)o * p->words : p->goal_mask;
            const Word *value = o < p->n_ops ? p->need + (size_t)o * p->words : p->goal;
            if (mentions(mask, field)) x->fact_of[field->offset + (int32_t)code(value, field)] = 0;
        }
    }
    for (int32_t fact = 0; fact < p->n_facts; fact++)
        if (!x->fact_of[fact]) x->fact_of[fact] = count++;
    return count;
}

/* Facts that an operator asks for, and those that it adds beside them. */
static int facts_of_op(const RelaxedProblem *x, const Problem *p, int32_t op, Ints *pre, Ints *add) {
    const Word *row = p->need_mask + (size_t)op * p->words;
    const Word *need = p->need + (size_t)op * p->words, *keep = p->keep + (size_t)op * p->words;
    const Word *put = p->put + (size_t)op * p->words;
    pre->count = add->count = 0;
    for (int32_t f = 0; f < p->n_fields; f++) {
        const Field *field = &p->fields[f];
        int32_t asked = mentions(row, field) ? field->offset + (int32_t)code(need, field) : NONE;
        if (asked != NONE && !ints_push(pre, x->fact_of[asked])) return 0;
        if (code(keep, field) == ((uint64_t)1 << field->width) - 1) continue;
        int32_t made = field->offset + (int32_t)code(put, field);
        if (made != asked && x->fact_of[made] != NONE && !ints_push(add, x->fact_of[made])) return 0;
    }
    return 1;
}

static int same(const int32_t *a, const Ints *b, int32_t count) {
    return (size_t)count == b->count && (!count || !memcmp(a, b->at, b->count * sizeof *a));
}

/* Classes of operators that look alike, in lists of pairs (class, fact). */
static int find_classes(RelaxedProblem *x, const Problem *p, Ints lists[4]) {
    Ints pre = {0}, add = {0}, pre_end = {0}, add_end = {0};
    size_t slots = 64;
    while (slots < 2 * (size_t)p->n_ops) slots *= 2;
    int32_t *slot = malloc(slots * sizeof *slot);
    int fine = slot != NULL;
    if (fine) memset(slot, 0xFF, slots * sizeof *slot);
    for (int32_t o = 0; fine && o < p->n_ops; o++) {
        fine = facts_of_op(x, p, o, &pre, &add);
        x->class_of[o] = NONE;
        if (!fine || !add.count) continue;
        uint32_t h = 2166136261u;
        for (size_t i = 0; i < pre.count; i++) h = (h ^ (uint32_t)pre.at[i]) * 16777619u;
        for (size_t i = 0; i < add.count; i++) h = (h ^ (uint32_t)add.at[i] ^ 0x80000000u) * 16777619u;
        size_t i = (h ^ h >> 15) & (slots - 1);
        for (; slot[i] != NONE; i = (i + 1) & (slots - 1)) {
            int32_t c = slot[i], from = c ? pre_end.at[c - 1] : 0, start = c ? add_end.at[c - 1] : 0;
            if (same(lists[1].at + from, &pre, pre_end.at[c] - from) && same(lists[3].at + start, &add, add_end.at[c] - start))
                break;
        }
        int32_t c = slot[i] == NONE ? x->n_ops : slot[i];
        x->class_of[o] = c;
        if (c < x->n_ops) {
            if (p->weight[o] < x->weight[c]) x->weight[c] = p->weight[o];
            continue;
        }
        slot[i] = x->n_ops++;
        x->weight[c] = p->weight[o];
        for (size_t j = 0; fine && j < pre.count; j++) fine = ints_push(&lists[0], c) && ints_push(&lists[1], pre.at[j]);
        for (size_t j = 0; fine && j < add.count; j++) fine = ints_push(&lists[2], c) && ints_push(&lists[3], add.at[j]);
        fine = fine && ints_push(&pre_end, (int32_t)lists[0].count) && ints_push(&add_end, (int32_t)lists[2].count);
        if (fine && !pre.count) fine = ints_push(&x->always, c);
    }
    free(slot), free(pre.at), free(add.at), free(pre_end.at), free(add_end.at);
    return fine;
}

static int relax(RelaxedProblem *x, const Problem *p) {
    size_t ops = (size_t)p->n_ops + 1;
    x->fact_of = malloc(((size_t)p->n_facts + 1) * sizeof *x->fact_of);
    x->class_of = malloc(ops * sizeof *x->class_of), x->weight = malloc(ops * sizeof *x->weight);
    Ints lists[4] = {{0}, {0}, {0}, {0}}; /* operator and fact asked for, operator and fact added */
    int fine = x->fact_of && x->class_of && x->weight;
    if (fine) x->n_facts = number_facts(x, p);
    fine = fine && find_classes(x, p, lists);
    for (int32_t f = 0; fine && f < p->n_fields; f++)
        if (mentions(p->goal_mask, &p->fields[f]))
            fine = ints_push(&x->goal, x->fact_of[p->fields[f].offset + (int32_t)code(p->goal, &p->fields[f])]);
    fine = fine && lists_of(&x->pre, x->n_ops, &lists[0], &lists[1]) && lists_of(&x->add, x->n_ops, &lists[2], &lists[3]) &&
           lists_of(&x->asked_by, x->n_facts, &lists[1], &lists[0]) && lists_of(&x->added_by, x->n_facts, &lists[3], &lists[2]);
    x->n_slots = (int32_t)lists[2].count;
    if (fine) x->adder = copied(lists[2].at, lists[2].count * sizeof(int32_t));
    Ints class = {0}, op = {0};
    for (int32_t o = 0; fine && o < p->n_ops; o++)
        if (x->class_of[o] != NONE) fine = ints_push(&class, x->class_of[o]) && ints_push(&op, o);
    fine = fine && lists_of(&x->members, x->n_ops, &class, &op);
    for (int i = 0; i < 4; i++) free(lists[i].at);
    free(class.at), free(op.at);
    return fine && x->adder;
}
