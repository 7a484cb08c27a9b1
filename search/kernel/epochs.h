/* Epoch by epoch: the states that sets of operators lead to beside one that is given for each epoch, each at its least
   cost, and what one more epoch in which nothing is given can leave behind.

   At most one operator of each agent is in a set, and no two that may not share an epoch.  Of what is left behind only
   some fields matter; what costs least of it, together with a bound on what follows, is told.  An epoch that comes earlier
   is as good as a later one, but for what costs the same. */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "a_star.h"
#include "like_fields.h"
#include "lists.h"
#include "problem.h"
#include "state_table.h"
#include "successor_generator.h"
#include "values.h"

enum {
    MOST_AGENTS = 64,
    COST_SHIFT = 32,    /* a cost is above so many bits of a number of actions */
    MOST_WAYS = 200000, /* sets from a state */
};

#define A_WHILE 0.008 /* seconds of new bounds from one state, at least, before the clock ends it */

/* Something that can be left behind. */
typedef struct {
    Cost total, paid; /* what it costs, with a bound on what follows, and without */
    int32_t state, end; /* the state before the epoch, in its layer; what is left behind */
} Leaving;

typedef struct {
    Problem problem;
    uint64_t *agents; /* per operator, a bit for each of its agents */
    Word *apart;      /* per operator those, as bits, with which it may not share an epoch */
    AStar *after;     /* what follows an end; its states have the lowest words of these */
    Word *mask;       /* the fields that matter to it */
    uint8_t *lost;    /* per fact whether nothing follows from it */
    Ints losing;      /* the fields that have such */
    uint8_t *loses;   /* per operator whether it sets one, or nothing that matters before an end */
    Word *unsettled;  /* the fields of the state under the cursor that have such values; */
    Word *settled;    /* a row per agent: those of them that operators of agents from this one on set */
    Cost unit;        /* what a unit of its costs weighs here */
    Table *layers, ends;
    Ints *alike;      /* per layer the fields that are, as in A* */
    int32_t *way;     /* per layer the state that a way leads by */
    int32_t n_layers, room, given; /* given: the operator of the epoch, or NONE */
    Leaving *leavings;
    size_t n_leavings, leavings_room, wanted;
    Ints applicable, sorted;
    size_t next_agent[MOST_AGENTS + 1]; /* where operators of agents from this one on begin, among the sorted ones */
    int32_t cursor, chosen[MOST_AGENTS];
    Word *row, *other, *real, *kept, *made; /* three rows; rows by depth */
    Cost limit, sought;  /* what is dearer does not matter; the cost of a set that is looked for, or NONE */
    const Word *target;  /* the state that it leads to */
    int32_t found;       /* how many operators are in it */
    const Ints *alike_now; /* of the layer that sets lead to */
    int is_end, hopeless; /* whether nothing is given; see take_end */
    int any_unsettled;
    int32_t sets;        /* of the state under the cursor so far */
    int outcome, is_fresh; /* why a slice ends; whether there was no new bound in it yet */
    double until;        /* when it ends */
    uint64_t last;       /* the agent to whom what follows is left: the last one, as a bit */
    int is_back;         /* whether all epochs are over and are gone through backwards, */
    int32_t layer;       /* from which layer, */
    Cost least;          /* and the least from the state under the cursor, what was paid for it included going forward */
} Epochs;

static void epochs_free(Epochs *e) {
    if (!e) return;
    for (int32_t i = 0; i < e->n_layers; i++) table_free(&e->layers[i]), free(e->alike[i].at);
    table_free(&e->ends), problem_free(&e->problem);
    free(e->layers), free(e->leavings), free(e->agents), free(e->apart), free(e->mask), free(e->lost), free(e->losing.at);
    free(e->loses), free(e->unsettled), free(e->settled), free(e->alike), free(e->way);
    free(e->applicable.at), free(e->sorted.at), free(e->row), free(e->other), free(e->real), free(e->kept), free(e->made);
    free(e);
}

static int find_losing(Epochs *e) {
    for (int32_t f = 0; f < e->problem.n_fields; f++)
        if (memchr(e->lost + e->problem.fields[f].offset, 1, (size_t)values_of(&e->problem, f)) && !ints_push(&e->losing, f)) return 0;
    return 1;
}

static int is_lost(const Epochs *e, const Word *state, const Field *field) {
    return e->lost[field->offset + (int32_t)code(state, field)];
}

/* Which operators are of no use before an end: they set a value that nothing follows from, or nothing that matters to what
   follows, or to whether anything does. */
static void find_losers(Epochs *e) {
    const Problem *p = &e->problem;
    for (int32_t op = 0; op < p->n_ops; op++) {
        const size_t row = (size_t)op * p->words;
        Word changes = 0;
        for (int32_t w = 0; w < e->ends.words; w++) changes |= ~p->keep[row + w] & e->mask[w];
        for (size_t i = 0; i < e->losing.count && !e->loses[op]; i++) {
            const Field *field = &p->fields[e->losing.at[i]];
            if (code(p->keep + row, field)) continue;
            e->loses[op] = is_lost(e, p->put + row, field), changes = 1;
        }
        e->loses[op] |= !changes;
    }
}

/* The fields of a state that have to be set by the end, if this is it; who can. */
static void find_unsettled(Epochs *e, const Word *state) {
    const Problem *p = &e->problem;
    const size_t words = (size_t)p->words;
    e->any_unsettled = 0;
    if (!e->is_end) return;
    memset(e->unsettled, 0, words * sizeof(Word));
    for (size_t i = 0; i < e->losing.count; i++) {
        const Field *field = &p->fields[e->losing.at[i]];
        if (is_lost(e, state, field)) put_code(e->unsettled, field, ((uint64_t)1 << field->width) - 1), e->any_unsettled = 1;
    }
    if (!e->any_unsettled) return;
    memset(e->settled + MOST_AGENTS * words, 0, words * sizeof(Word));
    for (int agent = MOST_AGENTS; agent-- > 0;) {
        Word *row = e->settled + (size_t)agent * words;
        memcpy(row, row + words, words * sizeof(Word));
        for (size_t i = e->next_agent[agent]; i < e->next_agent[agent + 1]; i++)
            for (size_t w = 0; w < words; w++) row[w] |= e->unsettled[w] & ~p->keep[(size_t)e->sorted.at[i] * words + w];
    }
}

/* Whether a set leaves such a field as it is, but for those that are in `but`, if there is any. */
static int is_unsettled(const Epochs *e, int32_t depth, const Word *but) {
    const size_t words = (size_t)e->problem.words;
    if (!e->any_unsettled) return 0;
    for (size_t w = 0; w < words; w++)
        if (e->unsettled[w] & e->kept[(size_t)depth * words + w] & ~(but ? but[w] : 0)) return 1;
    return 0;
}

static Epochs *epochs_of(const Spec *spec, const uint64_t *agents, const Word *apart, AStar *after, const Word *mask,
                         const uint8_t *lost, Cost unit) {
    Epochs *e = calloc(1, sizeof *e);
    if (!e) return NULL;
    size_t ops = (size_t)spec->n_ops, row = (size_t)spec->words * sizeof(Word);
    for (int32_t o = 0; o < spec->n_ops; o++) e->last |= agents[o];
    while (e->last & (e->last - 1)) e->last &= e->last - 1;
    e->after = after, e->unit = unit, e->ends.words = after->problem->words;
    e->agents = copied(agents, ops * sizeof *agents), e->apart = copied(apart, ops * ((ops + 63) / 64) * sizeof *apart);
    e->mask = copied(mask, (size_t)e->ends.words * sizeof(Word));
    e->applicable.at = malloc((ops + 1) * sizeof(int32_t)), e->sorted.at = malloc((ops + 1) * sizeof(int32_t));
    e->row = malloc(row), e->other = malloc(row), e->real = malloc(row), e->kept = malloc((MOST_AGENTS + 1) * row), e->made = malloc((MOST_AGENTS + 1) * row);
    e->lost = copied(lost, (size_t)spec->n_facts), e->loses = calloc(ops + 1, 1);
    e->unsettled = malloc(row), e->settled = malloc((MOST_AGENTS + 1) * row);
    if (problem_new(&e->problem, spec) && e->lost && e->loses && e->unsettled && e->settled && find_losing(e) && plant_all(&e->problem) && e->agents && e->apart && e->mask && e->applicable.at &&
        e->sorted.at && e->row && e->other && e->real && e->kept && e->made) {
        find_losers(e);
        return e;
    }
    epochs_free(e);
    return NULL;
}

/* One more layer, empty; whether there was memory. */
static int add_layer(Epochs *e) {
    if (e->n_layers == e->room) {
        int32_t room = e->room ? 2 * e->room : 64;
        Table *layers = realloc(e->layers, (size_t)room * sizeof *layers);
        if (layers) e->layers = layers;
        Ints *alike = realloc(e->alike, (size_t)room * sizeof *alike);
        if (alike) e->alike = alike;
        int32_t *way = realloc(e->way, (size_t)room * sizeof *way);
        if (way) e->way = way;
        if (!layers || !alike || !way) return 0;
        e->room = room;
    }
    e->alike[e->n_layers] = (Ints){0};
    e->layers[e->n_layers++] = (Table){.words = e->problem.words};
    return 1;
}

static int lacks(Epochs *e, const Table *t) {
    e->wanted = t->wanted, e->outcome = MEMORY;
    return 0;
}

/* Whether there is time for one more bound: what was bounded before is passed quickly when a state is gone through again. */
static int has_time(Epochs *e) {
    double time = now();
    if (e->is_fresh) e->is_fresh = 0, e->until = e->until > time + A_WHILE ? e->until : time + A_WHILE;
    if (time < e->until) return 1;
    e->outcome = RUNNING;
    return 0;
}

static int epochs_begin(Epochs *e, const Word *state, size_t allowed) {
    if (!e->n_layers && !add_layer(e)) return MEMORY;
    grant(&e->layers[0], allowed);
    if (!reserve(&e->layers[0], 1)) return lacks(e, &e->layers[0]), MEMORY;
    int is_new;
    find(&e->layers[0], state, &is_new);
    return FOUND;
}

/* What follows, as it weighs here; no more than MOST_COST. */
static Cost weighed(const Epochs *e, Cost rest) {
    if (rest == INFINITE_COST) return rest;
    if (rest >> COST_SHIFT >= (MOST_COST >> COST_SHIFT) / e->unit) return MOST_COST;
    return (rest >> COST_SHIFT) * e->unit * ((Cost)1 << COST_SHIFT) + (rest & (((Cost)1 << COST_SHIFT) - 1));
}

static int too_dear(const Epochs *e, Cost paid, Cost rest) { return rest == INFINITE_COST || paid + rest >= e->limit; }

static int leave(Epochs *e, Cost paid, Cost total, int32_t end) {
    if (e->n_leavings == e->leavings_room) {
        size_t room = e->leavings_room ? 2 * e->leavings_room : 256;
        if (!allow(&e->ends, (room - e->leavings_room) * sizeof *e->leavings)) return 0;
        Leaving *at = realloc(e->leavings, room * sizeof *at);
        if (!at) return e->ends.wanted = SIZE_MAX, 0;
        e->leavings = at, e->leavings_room = room;
    }
    e->leavings[e->n_leavings++] = (Leaving){total, paid, e->cursor, end};
    return 1;
}

/* Of a state that is left behind what matters to what follows, into `row`. */
static void keep_what_matters(Epochs *e, const Word *state) {
    for (int32_t w = 0; w < e->ends.words; w++) e->row[w] = state[w] & e->mask[w];
    represent(e->after->problem, &e->after->alike, e->row);
}

static void note_least(Epochs *e, Cost paid, Cost rest) {
    if (rest != INFINITE_COST && paid + rest < e->least) e->least = paid + rest;
}

/* A state that can be left behind: nothing new, if it was there in an earlier epoch at less.  `hopeless`: whether it costs
   too much, so that nothing does any good that could as well be done after it. */
static int take_end(Epochs *e, const Word *state, Cost paid) {
    Table *t = &e->ends;
    e->hopeless = 0;
    if (!reserve(t, 1)) return 0;
    keep_what_matters(e, state);
    int is_new;
    int32_t id = find(t, e->row, &is_new);
    Node *node = node_of(t, id);
    uint32_t epoch = (uint32_t)e->n_layers;
    if (!is_new && (node->stamp == epoch ? node->spent <= paid : node->spent >> COST_SHIFT < paid >> COST_SHIFT)) {
        e->hopeless = too_dear(e, paid, node->rest);
        note_least(e, paid, node->rest);
        return 1;
    }
    if (is_new) node->spent = INFINITE_COST;
    if (!node->evaluated && !too_dear(e, paid, node->rest)) {
        if (!has_time(e)) return 0;
        Cost rest = a_star_bound(e->after, e->row, t->allowed);
        if (rest < 0) return t->wanted = e->after->table.wanted, 0;
        node->rest = weighed(e, rest), node->evaluated = 1;
    }
    e->hopeless = too_dear(e, paid, node->rest);
    note_least(e, paid, node->rest);
    if (!e->hopeless && !leave(e, paid, paid + node->rest, id)) return 0;
    node->spent = paid, node->stamp = epoch;
    return 1;
}

static int take_state(Epochs *e, const Word *state, Cost paid) {
    Table *t = &e->layers[e->n_layers - 1];
    if (!reserve(t, 1)) return 0;
    int is_new;
    Node *node = node_of(t, find(t, state, &is_new));
    if (is_new || paid < node->spent) node->spent = paid, node->parent = e->cursor;
    return 1;
}

/* A state of the next layer that a set leads to, with what is left from there, if it was met. */
static int look_back(Epochs *e, Cost paid) {
    const Table *t = &e->layers[e->layer + 1];
    int32_t id = met(t, e->row);
    if (id != NONE) note_least(e, paid, node_of(t, id)->rest);
    return 1;
}

/* What is left from a state of a layer, by all ways or by those that leave something behind at once; NONE: not met. */
static Cost rest_from(Epochs *e, int32_t layer, const Word *state, int at_once) {
    memcpy(e->other, state, (size_t)e->problem.words * sizeof(Word));
    represent(&e->problem, &e->alike[layer], e->other);
    int32_t id = met(&e->layers[layer], e->other);
    if (id == NONE) return NONE;
    const Node *node = node_of(&e->layers[layer], id);
    return at_once ? node->at_once : node->rest;
}

/* What a set makes of the state under the cursor; 0: no need to go on. */
static int come_to(Epochs *e, const Word *state, int32_t depth, Cost paid) {
    int32_t words = e->problem.words;
    Word *made = e->row;
    const Word *kept = e->kept + (size_t)depth * words, *put = e->made + (size_t)depth * words;
    for (int32_t w = 0; w < words; w++) made[w] = (state[w] & kept[w]) | put[w];
    if (e->target && paid != e->sought) return 1;
    if (!e->is_end) represent(&e->problem, e->alike_now, made);
    if (e->target) {
        if (e->is_end) keep_what_matters(e, made);
        if (!is_same(made, e->target, e->is_end ? e->ends.words : words)) return 1;
        e->found = depth;
        return 0;
    }
    if (e->is_back) return look_back(e, paid);
    if (++e->sets > MOST_WAYS) return e->outcome = HOPELESS, 0;
    if (e->is_end ? take_end(e, made, paid) : take_state(e, made, paid)) return 1;
    return e->outcome == RUNNING ? 0 : lacks(e, e->is_end ? &e->ends : &e->layers[e->n_layers - 1]);
}

static void choose(Epochs *e, int32_t op, int32_t depth) {
    size_t words = (size_t)e->problem.words, row = (size_t)op * words;
    for (size_t w = 0; w < words; w++) {
        e->kept[(depth + 1) * words + w] = e->kept[depth * words + w] & e->problem.keep[row + w];
        e->made[(depth + 1) * words + w] = e->made[depth * words + w] | e->problem.put[row + w];
    }
    e->chosen[depth] = op;
}

static int fits(const Epochs *e, int32_t op, int32_t depth) {
    const Word *apart = e->apart + (size_t)op * (((size_t)e->problem.n_ops + 63) / 64);
    for (int32_t i = 0; i < depth; i++)
        if (apart[e->chosen[i] >> 6] >> (e->chosen[i] & 63) & 1) return 0;
    return 1;
}

/* Whether an operator could as well be done after a set. */
static int can_follow(const Epochs *e, int32_t op, const Word *state, int32_t depth) {
    int32_t words = e->problem.words;
    const Word *kept = e->kept + (size_t)depth * words, *put = e->made + (size_t)depth * words;
    for (int32_t w = 0; w < words; w++) e->other[w] = (state[w] & kept[w]) | put[w];
    return is_allowed(&e->problem, op, e->other);
}

/* All sets with more operators of agents from one on; 0: no need to go on. */
static int go_through(Epochs *e, const Word *state, int32_t agent, uint64_t busy, int32_t depth, Cost paid) {
    const int unsettled = is_unsettled(e, depth, NULL);
    if (!unsettled && !come_to(e, state, depth, paid)) return 0;
    const int in_vain = unsettled || (e->is_end && !e->target && e->hopeless);
    for (; agent < MOST_AGENTS && e->next_agent[agent] < e->sorted.count; agent++) {
        if (unsettled && is_unsettled(e, depth, e->settled + (size_t)agent * (size_t)e->problem.words)) return 1;
        if (busy >> agent & 1) continue;
        for (size_t i = e->next_agent[agent]; i < e->next_agent[agent + 1]; i++) {
            int32_t op = e->sorted.at[i];
            Cost more = paid + e->problem.weight[op];
            if (e->agents[op] & busy || more >= e->limit || !fits(e, op, depth)) continue;
            if (in_vain && e->agents[op] == e->last && can_follow(e, op, state, depth)) continue;
            choose(e, op, depth);
            if (!go_through(e, state, agent + 1, busy | e->agents[op], depth + 1, more)) return 0;
        }
    }
    return 1;
}

static int first_agent(uint64_t agents) {
    int agent = 0;
    while (!(agents >> agent & 1)) agent++;
    return agent;
}

static void leave_losers(Epochs *e) {
    size_t kept = 0;
    for (size_t i = 0; i < e->applicable.count; i++)
        if (!e->loses[e->applicable.at[i]]) e->applicable.at[kept++] = e->applicable.at[i];
    e->applicable.count = kept;
}

/* Applicable operators by the first of their agents, at an end without those that nothing follows from. */
static void sort_by_agent(Epochs *e, const Word *state) {
    successors(&e->problem, state, &e->applicable);
    size_t count[MOST_AGENTS + 1] = {0};
    if (e->is_end) leave_losers(e);
    for (size_t i = 0; i < e->applicable.count; i++) count[first_agent(e->agents[e->applicable.at[i]]) + 1]++;
    for (int agent = 0; agent < MOST_AGENTS; agent++) count[agent + 1] += count[agent];
    memcpy(e->next_agent, count, sizeof count);
    for (size_t i = 0; i < e->applicable.count; i++) {
        int32_t op = e->applicable.at[i];
        e->sorted.at[count[first_agent(e->agents[op])]++] = op;
    }
    e->sorted.count = e->applicable.count;
}

/* Every set from a state with the operator that is given, if one is. */
static int from_state(Epochs *e, const Word *state, Cost paid, int32_t given) {
    const Problem *p = &e->problem;
    memset(e->kept, 0xFF, (size_t)p->words * sizeof(Word)), memset(e->made, 0, (size_t)p->words * sizeof(Word));
    if (given != NONE && !is_allowed(p, given, state)) return 1;
    sort_by_agent(e, state);
    find_unsettled(e, state);
    if (given == NONE) return go_through(e, state, 0, 0, 0, paid);
    if ((paid += p->weight[given]) >= e->limit) return 1;
    choose(e, given, 0);
    return go_through(e, state, 0, e->agents[given], 1, paid);
}

/* Begin with the next epoch; NONE: nothing is given in it.  After it these fields are alike, also to all that is given later. */
static int epochs_next(Epochs *e, int32_t given, const int32_t *fields, int32_t count) {
    e->is_end = given == NONE, e->given = given, e->cursor = 0, e->n_leavings = 0;
    if (e->is_end) return 1;
    if (!add_layer(e)) return 0;
    return set_alike(&e->alike[e->n_layers - 1], fields, count);
}

/* A slice of it: what can be left behind if nothing is given, else the next layer.  What is not below the limit, which is
   MOST_COST at most, is left out.  HOPELESS: a state has too many sets. */
static int epochs_run(Epochs *e, Cost limit, double seconds, size_t allowed) {
    double end = now() + seconds;
    e->target = NULL, e->limit = limit, e->until = end, e->is_fresh = 1, e->alike_now = &e->alike[e->n_layers - 1];
    const Table *from = &e->layers[e->n_layers - (e->is_end ? 1 : 2)];
    grant(e->is_end ? &e->ends : &e->layers[e->n_layers - 1], allowed);
    for (; e->cursor < from->count; e->cursor++) {
        if (now() >= end) return RUNNING;
        Node *node = node_of(from, e->cursor);
        e->sets = 0, e->outcome = FOUND, e->least = INFINITE_COST;
        if (!from_state(e, state_of(from, e->cursor), node->spent, e->given)) return e->outcome;
        if (e->is_end) node->rest = e->least == INFINITE_COST ? INFINITE_COST : e->least - node->spent;
    }
    return FOUND;
}

/* A slice of going back, once all epochs are over, under the lowest of their limits: the least that is left from each state
   of each layer to what can be left behind then or later, and a bound on what follows; no more than what of the limit was
   left on the cheapest way to the state. */
static int epochs_go_back(Epochs *e, const int32_t *given, Cost limit, double seconds) {
    double end = now() + seconds;
    if (!e->is_back) e->is_back = 1, e->is_end = 0, e->layer = e->n_layers - 1, e->cursor = 0, e->target = NULL;
    for (; e->layer >= 0; e->layer--, e->cursor = 0) {
        const Table *t = &e->layers[e->layer];
        if (e->layer + 1 < e->n_layers) e->alike_now = &e->alike[e->layer + 1];
        for (; e->cursor < t->count; e->cursor++) {
            if (now() >= end) return RUNNING;
            Node *node = node_of(t, e->cursor);
            e->limit = limit > node->spent ? limit - node->spent : 0;
            node->at_once = e->least = e->limit < node->rest ? e->limit : node->rest;
            if (e->layer + 1 < e->n_layers) from_state(e, state_of(t, e->cursor), 0, given[e->layer]);
            node->rest = e->least;
        }
    }
    return FOUND;
}
