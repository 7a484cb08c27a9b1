/* Classical planning over packed states: optimal search with admissible bounds, greedy search for a first plan.

   A state is a row of 64-bit words, the same bits as the Python int of search/packed; an operator is four such
   rows, so what is compiled here and what Python does are one and the same arithmetic.  Nothing here knows of
   agents, epochs or windows.  Work goes on in slices: whoever calls looks at the time and the memory between
   two of them, and nothing is allocated that was not allowed for.

   Sources: A* (Hart, Nilsson and Raphael 1968), with reopening and evaluation when a state comes up; LM-cut (Helmert and
   Domshlak 2009), several times with ties between preconditions broken otherwise (Lauer and Fickert 2020), whose
   landmarks bound the successors as well (after Pommerening and Helmert 2013); strong stubborn sets (Wehrle and
   Helmert 2014); saturated cost partitioning (Seipp, Keller and Helmert 2020); adaptive bounds from earlier searches (Koenig and Likhachev 2005); lazy greedy search with
   preferred operators (Richter and Westphal 2010) on the FF heuristic (Hoffmann and Nebel 2001) over additive
   supporters (Keyder and Geffner 2008). */

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifndef KERNEL_SOURCE_HASH
#define KERNEL_SOURCE_HASH ""
#endif

#if defined(_WIN32)
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif

typedef uint64_t Word;
typedef int64_t Cost;

#define INFINITE_COST INT64_MAX
#define NONE (-1)

API const char *kernel_source_hash(void) { return KERNEL_SOURCE_HASH; }

static double now(void) {
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- growing arrays of 32-bit numbers ---- */

typedef struct {
    int32_t *at;
    size_t count, room;
} Ints;

static int ints_push(Ints *list, int32_t value) {
    if (list->count == list->room) {
        size_t room = list->room ? 2 * list->room : 64;
        int32_t *at = realloc(list->at, room * sizeof *at);
        if (!at) return 0;
        list->at = at, list->room = room;
    }
    list->at[list->count++] = value;
    return 1;
}

/* The same where there is room already. */
static inline void put(Ints *list, int32_t value) { list->at[list->count++] = value; }

/* Lists of numbers, one after another: those of i are at[start[i]] .. at[start[i + 1] - 1]. */
typedef struct {
    int32_t *start, *at;
} Lists;

static void lists_free(Lists *lists) { free(lists->start), free(lists->at); }

/* Pairs (which[i], value[i]) sorted into lists by the first. */
static int lists_of(Lists *lists, int32_t count, const Ints *which, const Ints *value) {
    lists->start = calloc((size_t)count + 2, sizeof *lists->start);
    lists->at = malloc((which->count + 1) * sizeof *lists->at);
    if (!lists->start || !lists->at) return 0;
    for (size_t i = 0; i < which->count; i++) lists->start[which->at[i] + 2]++;
    for (int32_t i = 0; i < count; i++) lists->start[i + 2] += lists->start[i + 1];
    for (size_t i = 0; i < which->count; i++) lists->at[lists->start[which->at[i] + 1]++] = value->at[i];
    return 1;
}

static void *copied(const void *source, size_t size) {
    void *copy = malloc(size ? size : 1);
    if (copy && size) memcpy(copy, source, size);
    return copy;
}

/* ---- heaps ---- */

typedef struct {
    Cost key, second;
    int32_t item, third;
} Entry;

typedef struct {
    Entry *at;
    size_t count, room;
} Heap;

static int before(const Entry *a, const Entry *b) {
    if (a->key != b->key) return a->key < b->key;
    if (a->second != b->second) return a->second < b->second;
    return a->third > b->third; /* the latest first */
}

static int heap_push(Heap *heap, Entry entry) {
    if (heap->count == heap->room) {
        size_t room = heap->room ? heap->room + heap->room / 2 : 1024;
        Entry *at = realloc(heap->at, room * sizeof *at);
        if (!at) return 0;
        heap->at = at, heap->room = room;
    }
    size_t i = heap->count++;
    while (i && before(&entry, &heap->at[(i - 1) / 2])) heap->at[i] = heap->at[(i - 1) / 2], i = (i - 1) / 2;
    heap->at[i] = entry;
    return 1;
}

static Entry heap_pop(Heap *heap) {
    Entry top = heap->at[0], last = heap->at[--heap->count];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= heap->count) break;
        if (child + 1 < heap->count && before(&heap->at[child + 1], &heap->at[child])) child++;
        if (!before(&heap->at[child], &last)) break;
        heap->at[i] = heap->at[child], i = child;
    }
    if (heap->count) heap->at[i] = last;
    return top;
}

/* ---- the problem ---- */

typedef struct {
    int32_t shift, width, offset; /* lowest bit; bits; number of its first fact */
} Field;

typedef struct {
    int32_t words, n_ops, n_fields, n_facts, n_forbidden;
    Word *need_mask, *need, *keep, *put; /* a row per operator */
    Word *forbidden;                     /* two rows, mask and value, per forbidden literal */
    Lists forbids;                       /* per operator its forbidden literals */
    Cost *weight;
    Field *fields;
    Word *goal_mask, *goal, *goal_forbidden;
    int32_t n_goal_forbidden;
    Ints tree;                           /* decision tree over preconditions, see plant() */
} Problem;

static uint64_t code(const Word *state, const Field *field) {
    int32_t word = field->shift >> 6, bit = field->shift & 63;
    uint64_t value = state[word] >> bit;
    if (bit + field->width > 64) value |= state[word + 1] << (64 - bit);
    return value & (((uint64_t)1 << field->width) - 1);
}

static int matches(const Word *state, const Word *mask, const Word *value, int32_t words) {
    for (int32_t i = 0; i < words; i++)
        if ((state[i] & mask[i]) != value[i]) return 0;
    return 1;
}

static int mentions(const Word *mask, const Field *field) { return code(mask, field) != 0; }

static int is_goal(const Problem *p, const Word *state) {
    if (!matches(state, p->goal_mask, p->goal, p->words)) return 0;
    for (int32_t i = 0; i < p->n_goal_forbidden; i++)
        if (matches(state, p->goal_forbidden + 2 * i * p->words, p->goal_forbidden + (2 * i + 1) * p->words, p->words))
            return 0;
    return 1;
}

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

/* Applicable operators; `found` has room for all of them. */
static void successors(const Problem *p, const Word *state, Ints *found) {
    found->count = 0;
    if (p->n_ops) climb(p, state, 0, found);
}

/* ---- states that were met ---- */

enum { CHUNK_BITS = 12, CHUNK = 1 << CHUNK_BITS };

typedef struct {
    Cost spent, rest; /* spent in the search `stamp`; rest: no plan from here is cheaper */
    int32_t parent, op;
    uint32_t stamp;
    uint8_t exact, evaluated, projected, closed;
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

static size_t hash(const Word *state, int32_t words) {
    Word h = 0x9E3779B97F4A7C15u;
    for (int32_t i = 0; i < words; i++) {
        h = (h ^ state[i]) * 0xBF58476D1CE4E5B9u;
        h ^= h >> 29;
    }
    h *= 0x94D049BB133111EBu;
    return (size_t)(h ^ (h >> 32));
}

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

/* The number of a state, which is added where it is new; there is room for one more. */
static int32_t find(Table *t, const Word *state, int *is_new) {
    size_t i = hash(state, t->words) & (t->n_slots - 1);
    for (; t->slots[i] != NONE; i = (i + 1) & (t->n_slots - 1))
        if (!memcmp(state_of(t, t->slots[i]), state, (size_t)t->words * sizeof *state)) {
            *is_new = 0;
            return t->slots[i];
        }
    int32_t id = t->count++;
    t->slots[i] = id;
    memcpy(state_of(t, id), state, (size_t)t->words * sizeof *state);
    memset(node_of(t, id), 0, sizeof(Node));
    *is_new = 1;
    return id;
}

static void table_free(Table *t) {
    for (size_t i = 0; i < t->chunks; i++) free(t->states[i]), free(t->nodes[i]);
    free(t->states), free(t->nodes), free(t->slots);
}

/* ---- the relaxed problem: LM-cut and FF ---- */

/* What nobody asks for is left out, and what must not be.  Operators that ask for and add the same facts are one, the
   cheapest of them. */
typedef struct {
    int32_t n_ops, n_facts, n_slots;
    int32_t *fact_of, *class_of; /* of the problem's facts and operators; NONE: left out */
    Cost *weight;
    Lists pre, add, asked_by, added_by; /* operators' facts, facts' operators */
    int32_t *adder;                     /* per place in add.at its operator */
    Ints goal, always;                  /* always: operators that ask for nothing */
} RelaxedProblem;

static void relaxed_problem_free(RelaxedProblem *x) {
    free(x->fact_of), free(x->class_of), free(x->weight), free(x->adder), free(x->goal.at), free(x->always.at);
    lists_free(&x->pre), lists_free(&x->add), lists_free(&x->asked_by), lists_free(&x->added_by);
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
    for (int i = 0; i < 4; i++) free(lists[i].at);
    return fine && x->adder;
}

/* Facts that wait to be looked at, cheapest first, the latest of those first; one list per cost. */
typedef struct {
    Cost *key; /* descending */
    int32_t *first, count;
    int32_t *next, *last; /* of a fact in its list */
} Queue;

static int32_t queue_place(const Queue *q, Cost key) {
    int32_t i = q->count;
    while (i && q->key[i - 1] < key) i--;
    return i;
}

static void queue_push(Queue *q, Cost key, int32_t fact) {
    int32_t i = queue_place(q, key);
    if (!i || q->key[i - 1] != key) {
        memmove(q->key + i + 1, q->key + i, (size_t)(q->count - i) * sizeof *q->key);
        memmove(q->first + i + 1, q->first + i, (size_t)(q->count - i) * sizeof *q->first);
        q->key[i] = key, q->first[i] = fact, q->count++;
        q->next[fact] = NONE;
    } else {
        int32_t first = q->first[i - 1];
        q->next[fact] = first, q->last[first] = fact, q->first[i - 1] = fact;
    }
    q->last[fact] = NONE;
}

static void queue_remove(Queue *q, Cost key, int32_t fact) {
    int32_t next = q->next[fact], last = q->last[fact];
    if (next != NONE) q->last[next] = last;
    if (last != NONE) {
        q->next[last] = next;
        return;
    }
    int32_t i = queue_place(q, key) - 1;
    q->first[i] = next;
    if (next != NONE) return;
    q->count--;
    memmove(q->key + i, q->key + i + 1, (size_t)(q->count - i) * sizeof *q->key);
    memmove(q->first + i, q->first + i + 1, (size_t)(q->count - i) * sizeof *q->first);
}

static int32_t queue_pop(Queue *q) {
    int32_t fact = q->first[q->count - 1], next = q->next[fact];
    if (next == NONE) q->count--;
    else q->first[q->count - 1] = next, q->last[next] = NONE;
    return fact;
}

typedef struct {
    Cost cost, supporter_cost;
    int32_t supporter, unsatisfied; /* supporter: a fact, NONE where nothing is asked for */
    int32_t first_add, end_add;     /* what it adds in add.at */
} RelaxedOp;

typedef struct {
    RelaxedProblem problem;
    RelaxedOp *ops, *fresh, *explored;
    Cost *cost, *explored_cost; /* h_max of facts */
    uint8_t *waiting;
    uint32_t *mark, *op_mark, round; /* marks are of a round: in the goal zone, before it, neither */
    int32_t *free_adder, *next_free; /* per fact the places in add.at of operators that cost nothing any more */
    int32_t *supporter;              /* FF: operator per fact */
    uint8_t *chosen;
    int solvable;
    Queue queue;
    Ints zone, stack, cut, initial;
    const Word *explored_from; /* the state that `explored` is about */
    const Cost *priority;      /* breaks ties between facts, the greatest first; NULL: the one that was there */
    Cost *priorities;          /* the fewest operators that add it; of these most that ask for it, or the last */
} Relaxed;

enum { N_PRIORITIES = 2, N_TURNS = N_PRIORITIES + 1 };

static int relaxed_new(Relaxed *r, const Problem *p) {
    RelaxedProblem *x = &r->problem;
    if (!relax(x, p)) return 0;
    size_t ops = (size_t)x->n_ops + 1, facts = (size_t)x->n_facts + 1, slots = (size_t)x->n_slots + 1;
    r->ops = malloc(ops * sizeof *r->ops), r->explored = malloc(ops * sizeof *r->ops);
    r->fresh = malloc(ops * sizeof *r->ops);
    r->cost = malloc(facts * sizeof(Cost)), r->explored_cost = malloc(facts * sizeof(Cost));
    r->waiting = calloc(facts, 1), r->chosen = calloc(ops, 1);
    r->mark = calloc(facts, sizeof *r->mark), r->op_mark = calloc(ops, sizeof *r->op_mark);
    r->free_adder = malloc(facts * sizeof(int32_t)), r->next_free = malloc(slots * sizeof(int32_t));
    r->supporter = malloc(facts * sizeof(int32_t));
    r->queue.key = malloc(facts * sizeof(Cost)), r->queue.first = malloc(facts * sizeof(int32_t));
    r->queue.next = malloc(facts * sizeof(int32_t)), r->queue.last = malloc(facts * sizeof(int32_t));
    r->zone.at = malloc(facts * sizeof(int32_t)), r->stack.at = malloc((facts + slots) * sizeof(int32_t));
    r->cut.at = malloc(ops * sizeof(int32_t)), r->initial.at = malloc(facts * sizeof(int32_t));
    r->priorities = malloc(N_PRIORITIES * facts * sizeof *r->priorities);
    if (!(r->ops && r->explored && r->fresh && r->cost && r->explored_cost && r->waiting && r->chosen && r->mark &&
          r->op_mark && r->free_adder && r->next_free && r->supporter && r->queue.key && r->queue.first &&
          r->queue.next && r->queue.last && r->zone.at && r->stack.at && r->cut.at && r->initial.at && r->priorities))
        return 0;
    for (int32_t o = 0; o < x->n_ops; o++)
        r->fresh[o] = (RelaxedOp){x->weight[o], 0, NONE, x->pre.start[o + 1] - x->pre.start[o], x->add.start[o], x->add.start[o + 1]};
    for (int32_t f = 0; f < x->n_facts; f++) {
        Cost rare = INT32_MAX - (x->added_by.start[f + 1] - x->added_by.start[f]);
        r->priorities[f] = (rare << 32) + x->asked_by.start[f + 1] - x->asked_by.start[f];
        r->priorities[facts + (size_t)f] = (rare << 32) + f;
    }
    return 1;
}

static void relaxed_free(Relaxed *r) {
    relaxed_problem_free(&r->problem);
    free(r->ops), free(r->explored), free(r->fresh), free(r->cost), free(r->explored_cost), free(r->waiting), free(r->chosen);
    free(r->mark), free(r->op_mark), free(r->free_adder), free(r->next_free), free(r->supporter);
    free(r->queue.key), free(r->queue.first), free(r->queue.next), free(r->queue.last);
    free(r->zone.at), free(r->stack.at), free(r->cut.at), free(r->initial.at), free(r->priorities);
}

static void facts_of(const RelaxedProblem *x, const Problem *p, const Word *state, Ints *found) {
    found->count = 0;
    for (int32_t f = 0; f < p->n_fields; f++) {
        int32_t fact = x->fact_of[p->fields[f].offset + (int32_t)code(state, &p->fields[f])];
        if (fact != NONE) put(found, fact);
    }
}

static inline void reach(Relaxed *r, int32_t fact, Cost cost) {
    Cost old = r->cost[fact];
    if (cost >= old) return;
    if (r->waiting[fact]) queue_remove(&r->queue, old, fact);
    r->waiting[fact] = 1, r->cost[fact] = cost;
    queue_push(&r->queue, cost, fact);
}

static inline void add_facts(Relaxed *r, const RelaxedOp *op, Cost cost) {
    const int32_t *facts = r->problem.add.at;
    for (int32_t j = op->first_add, end = op->end_add; j < end; j++) reach(r, facts[j], cost);
}

static inline int32_t next_fact(Relaxed *r) {
    int32_t fact = queue_pop(&r->queue);
    r->waiting[fact] = 0;
    return fact;
}

static int goal_reached(const Relaxed *r) {
    for (size_t i = 0; i < r->problem.goal.count; i++)
        if (r->cost[r->problem.goal.at[i]] == INFINITE_COST) return 0;
    return 1;
}

static void start_from(Relaxed *r, const Problem *p, const Word *state) {
    const RelaxedProblem *x = &r->problem;
    facts_of(x, p, state, &r->initial);
    memcpy(r->ops, r->fresh, (size_t)x->n_ops * sizeof *r->ops);
    for (int32_t f = 0; f < x->n_facts; f++) r->cost[f] = INFINITE_COST;
    for (size_t i = 0; i < r->initial.count; i++) reach(r, r->initial.at[i], 0);
}

/* h_max from a state, with the fact that supports each operator; whether the goal is reached. */
static int explore(Relaxed *r, const Problem *p, const Word *state) {
    const RelaxedProblem *x = &r->problem;
    start_from(r, p, state);
    for (size_t i = 0; i < x->always.count; i++) add_facts(r, &r->ops[x->always.at[i]], r->ops[x->always.at[i]].cost);
    RelaxedOp *ops = r->ops;
    while (r->queue.count) {
        int32_t fact = next_fact(r);
        Cost cost = r->cost[fact];
        const int32_t *asking = x->asked_by.at + x->asked_by.start[fact], *end = x->asked_by.at + x->asked_by.start[fact + 1];
        for (; asking < end; asking++) {
            RelaxedOp *op = &ops[*asking];
            if (--op->unsatisfied) continue;
            op->supporter = fact, op->supporter_cost = cost;
            add_facts(r, op, cost + op->cost);
        }
    }
    return goal_reached(r);
}

/* The dearest of some facts; of those the one that was it before, or that has the greatest priority. */
static inline int32_t dearest(const Relaxed *r, const int32_t *facts, int32_t count, int32_t before) {
    const Cost *costs = r->cost, *priority = r->priority;
    int32_t best = before;
    Cost most = costs[before];
    for (int32_t k = 0; k < count; k++) {
        Cost cost = costs[facts[k]];
        if (cost > most || (priority && cost == most && priority[facts[k]] > priority[best])) best = facts[k], most = cost;
    }
    return best;
}

static inline int32_t dearest_asked(const Relaxed *r, int32_t op) {
    const Lists *pre = &r->problem.pre;
    return dearest(r, pre->at + pre->start[op], pre->start[op + 1] - pre->start[op], r->ops[op].supporter);
}

/* The same after operators of the cut have become cheaper. */
static void explore_again(Relaxed *r) {
    const RelaxedProblem *x = &r->problem;
    RelaxedOp *ops = r->ops;
    for (size_t i = 0; i < r->cut.count; i++) {
        const RelaxedOp *op = &ops[r->cut.at[i]];
        add_facts(r, op, op->supporter_cost + op->cost);
    }
    while (r->queue.count) {
        int32_t fact = next_fact(r);
        Cost cost = r->cost[fact];
        const int32_t *asking = x->asked_by.at + x->asked_by.start[fact], *end = x->asked_by.at + x->asked_by.start[fact + 1];
        for (; asking < end; asking++) {
            RelaxedOp *op = &ops[*asking];
            if (op->supporter != fact || op->supporter_cost <= cost || op->unsatisfied) continue;
            op->supporter = dearest_asked(r, *asking);
            Cost now_cost = r->cost[op->supporter];
            if (now_cost == op->supporter_cost) continue;
            op->supporter_cost = now_cost;
            add_facts(r, op, now_cost + op->cost);
        }
    }
}

/* Facts from which a fact costs nothing more. */
static void mark_zone(Relaxed *r, int32_t goal) {
    const RelaxedProblem *x = &r->problem;
    r->round += 3, r->zone.count = 0;
    r->mark[goal] = r->round;
    put(&r->zone, goal);
    for (size_t i = 0; i < r->zone.count; i++)
        for (int32_t j = r->free_adder[r->zone.at[i]]; j != NONE; j = r->next_free[j]) {
            int32_t from = r->ops[x->adder[j]].supporter;
            if (from == NONE || r->mark[from] == r->round) continue;
            r->mark[from] = r->round;
            put(&r->zone, from);
        }
}

/* Whether a fact can be reached without the zone, in which all facts cost at least `least`. */
static int is_before(Relaxed *r, int32_t fact, Cost least) {
    const RelaxedProblem *x = &r->problem;
    uint32_t before = r->round + 1, not_before = r->round + 2;
    if (r->cost[fact] < least || r->mark[fact] == before) return 1;
    if (r->mark[fact] == not_before) return 0;
    r->stack.count = 0;
    put(&r->stack, fact);
    r->mark[fact] = not_before;
    for (size_t i = 0; i < r->stack.count; i++) {
        int32_t at = r->stack.at[i];
        for (int32_t j = x->added_by.start[at]; j < x->added_by.start[at + 1]; j++) {
            const RelaxedOp *op = &r->ops[x->added_by.at[j]];
            if (op->unsatisfied) continue;
            int32_t from = op->supporter;
            if (from == NONE || r->cost[from] < least || r->mark[from] == before) {
                for (size_t k = 0; k < r->stack.count; k++) r->mark[r->stack.at[k]] = 0;
                r->mark[fact] = before;
                return 1;
            }
            if (r->mark[from] == r->round || r->mark[from] == not_before) continue;
            r->mark[from] = not_before;
            put(&r->stack, from);
        }
    }
    return 0;
}

/* Operators that lead into the zone: each plan needs one of them.  The least that one costs. */
static Cost find_cut(Relaxed *r, Cost least) {
    const RelaxedProblem *x = &r->problem;
    const RelaxedOp *ops = r->ops;
    const uint32_t *mark = r->mark, round = r->round;
    uint32_t *op_mark = r->op_mark;
    int32_t *cut = r->cut.at;
    size_t count = 0;
    Cost cheapest = INFINITE_COST;
    for (size_t i = 0; i < r->zone.count; i++) {
        int32_t fact = r->zone.at[i];
        const int32_t *adding = x->added_by.at + x->added_by.start[fact], *end = x->added_by.at + x->added_by.start[fact + 1];
        for (; adding < end; adding++) {
            const RelaxedOp *op = &ops[*adding];
            if (op->unsatisfied || !op->cost || op_mark[*adding] == round) continue;
            if (op->supporter_cost >= least && (mark[op->supporter] == round || !is_before(r, op->supporter, least))) continue;
            op_mark[*adding] = round, cut[count++] = *adding;
            if (op->cost < cheapest) cheapest = op->cost;
        }
    }
    r->cut.count = count;
    return cheapest;
}

/* The LM-cut value of a state of the table, which is known by its address; operators keep what it has not taken of
   their costs.  Ties are broken in one way per turn. */
static Cost lm_cut(Relaxed *r, const Problem *p, const Word *state, int32_t turn) {
    const RelaxedProblem *x = &r->problem;
    size_t ops = (size_t)x->n_ops, facts = (size_t)x->n_facts;
    r->priority = turn < N_PRIORITIES ? r->priorities + (size_t)turn * (facts + 1) : NULL;
    if (r->explored_from != state) {
        r->explored_from = state, r->solvable = explore(r, p, state);
        memcpy(r->explored, r->ops, ops * sizeof *r->ops);
        memcpy(r->explored_cost, r->cost, facts * sizeof *r->cost);
    } else {
        memcpy(r->ops, r->explored, ops * sizeof *r->ops);
        memcpy(r->cost, r->explored_cost, facts * sizeof *r->cost);
    }
    if (!r->solvable) return INFINITE_COST;
    if (!x->goal.count) return 0;
    if (r->priority)
        for (size_t o = 0; o < ops; o++)
            if (!r->ops[o].unsatisfied && r->ops[o].supporter != NONE) r->ops[o].supporter = dearest_asked(r, (int32_t)o);
    memset(r->free_adder, 0xFF, facts * sizeof *r->free_adder);
    if (r->round > UINT32_MAX / 2) {
        r->round = 0;
        memset(r->mark, 0, facts * sizeof *r->mark), memset(r->op_mark, 0, ops * sizeof *r->op_mark);
    }
    Cost total = 0;
    int32_t goal = x->goal.at[0];
    for (;;) {
        goal = dearest(r, x->goal.at, (int32_t)x->goal.count, goal);
        Cost most = r->cost[goal];
        if (!most) return total;
        mark_zone(r, goal);
        Cost least = find_cut(r, most);
        total += least;
        for (size_t i = 0; i < r->cut.count; i++) {
            int32_t op = r->cut.at[i];
            if (r->ops[op].cost -= least) continue;
            for (int32_t j = x->add.start[op]; j < x->add.start[op + 1]; j++)
                r->next_free[j] = r->free_adder[x->add.at[j]], r->free_adder[x->add.at[j]] = j;
        }
        explore_again(r);
    }
}

/* Number of operators of a relaxed plan, whose first ones are added to `preferred`; each costs 1. */
static Cost relaxed_plan(Relaxed *r, const Problem *p, const Word *state, Ints *preferred) {
    const RelaxedProblem *x = &r->problem;
    start_from(r, p, state);
    for (int32_t o = 0; o < x->n_ops; o++) r->ops[o].cost = 1;
    for (size_t i = 0; i < r->initial.count; i++) r->supporter[r->initial.at[i]] = NONE;
    for (size_t i = 0; i < x->always.count; i++) {
        int32_t op = x->always.at[i];
        for (int32_t k = x->add.start[op]; k < x->add.start[op + 1]; k++) {
            if (r->cost[x->add.at[k]] <= 1) continue;
            r->supporter[x->add.at[k]] = op;
            reach(r, x->add.at[k], 1);
        }
    }
    while (r->queue.count) {
        int32_t from = next_fact(r);
        for (int32_t j = x->asked_by.start[from]; j < x->asked_by.start[from + 1]; j++) {
            int32_t number = x->asked_by.at[j];
            RelaxedOp *op = &r->ops[number];
            op->cost += r->cost[from];
            if (--op->unsatisfied) continue;
            for (int32_t k = x->add.start[number]; k < x->add.start[number + 1]; k++) {
                int32_t fact = x->add.at[k];
                if (op->cost >= r->cost[fact]) continue;
                r->supporter[fact] = number;
                reach(r, fact, op->cost);
            }
        }
    }
    if (!goal_reached(r)) return INFINITE_COST;
    memset(r->chosen, 0, (size_t)x->n_ops);
    r->round += 3, r->zone.count = 0;
    for (size_t i = 0; i < x->goal.count; i++) {
        r->mark[x->goal.at[i]] = r->round;
        put(&r->zone, x->goal.at[i]);
    }
    Cost total = 0;
    for (size_t i = 0; i < r->zone.count; i++) {
        int32_t op = r->supporter[r->zone.at[i]];
        if (op == NONE || r->chosen[op]) continue;
        r->chosen[op] = 1, total++;
        if (r->ops[op].cost == 1) ints_push(preferred, op);
        for (int32_t j = x->pre.start[op]; j < x->pre.start[op + 1]; j++) {
            int32_t fact = x->pre.at[j];
            if (r->mark[fact] == r->round) continue;
            r->mark[fact] = r->round;
            put(&r->zone, fact);
        }
    }
    memset(r->chosen, 0, (size_t)x->n_ops);
    return total;
}

/* ---- projections that add up ---- */

#define FAR ((Cost)1 << 60)

/* The problem seen on a few fields.  Operators that look alike there are one class. */
typedef struct {
    Ints fields;
    int64_t *strides;
    int32_t n_states, n_classes;
    Lists members;           /* per class its operators */
    int32_t *source, *class; /* of each transition, by target */
    int32_t *first;          /* per target its first transition */
    uint8_t *goals;
    Cost *alone; /* distances where it may take all of the weights */
    double taken; /* and how much it takes then */
} Projection;

typedef struct {
    Projection *at;
    int32_t count, room, n_orders, n_samples;
    Cost **tables; /* n_orders times count; NULL where all is 0 */
    Word *samples;
    Cost *best;
    Cost *left, *needed, *steps, *found;
    int64_t *number;
    Heap heap;
} Projections;

static int64_t number_of(const Problem *p, const Projection *b, const Word *state) {
    int64_t number = 0;
    for (size_t i = 0; i < b->fields.count; i++)
        number += (int64_t)code(state, &p->fields[b->fields.at[i]]) * b->strides[i];
    return number;
}

static int32_t values_of(const Problem *p, int32_t field) {
    return (field + 1 < p->n_fields ? p->fields[field + 1].offset : p->n_facts) - p->fields[field].offset;
}

/* What an operator asks of a field in the pattern, and what it makes of it; NONE: nothing. */
static void seen(const Problem *p, const Projection *b, int32_t op, int32_t *asks, int32_t *makes) {
    size_t row = (size_t)op * p->words;
    for (size_t i = 0; i < b->fields.count; i++) {
        const Field *field = &p->fields[b->fields.at[i]];
        asks[i] = mentions(p->need_mask + row, field) ? (int32_t)code(p->need + row, field) : NONE;
        int sets = code(p->keep + row, field) != ((uint64_t)1 << field->width) - 1;
        makes[i] = sets ? (int32_t)code(p->put + row, field) : NONE;
        if (makes[i] == asks[i]) makes[i] = NONE;
    }
}

static int32_t look_width; /* numbers that say how an operator looks in a pattern */

static int compare_looks(const void *a, const void *b) {
    const int32_t *x = *(int32_t *const *)a, *y = *(int32_t *const *)b;
    int order = memcmp(x, y, (size_t)look_width * sizeof *x);
    return order ? order : (x[look_width] > y[look_width]) - (x[look_width] < y[look_width]);
}

static void projection_free(Projection *b) {
    free(b->fields.at), free(b->strides), lists_free(&b->members), free(b->source), free(b->class), free(b->first);
    free(b->goals), free(b->alone);
}

/* Call `visit` with every pair of states between which a class of operators leads. */
#define FOR_EACH_TRANSITION(look, k, body)                                                        \
    {                                                                                             \
        int64_t from = 0, shift = 0;                                                              \
        int32_t free_at[64], turn[64];                                                            \
        int n_free = 0;                                                                           \
        for (size_t i_ = 0; i_ < (k); i_++) {                                                     \
            int32_t asks_ = (look)[i_], makes_ = (look)[(k) + i_];                                \
            if (asks_ != NONE) from += asks_ * b->strides[i_];                                    \
            else free_at[n_free] = (int32_t)i_, turn[n_free++] = 0;                               \
            if (asks_ != NONE && makes_ != NONE) shift += (makes_ - asks_) * b->strides[i_];      \
        }                                                                                         \
        for (;;) {                                                                                \
            int64_t to = from + shift;                                                            \
            for (int j_ = 0; j_ < n_free; j_++) {                                                 \
                int32_t makes_ = (look)[(k) + free_at[j_]];                                       \
                if (makes_ != NONE) to += (makes_ - turn[j_]) * b->strides[free_at[j_]];          \
            }                                                                                     \
            if (to != from) body;                                                                 \
            int j_ = 0;                                                                           \
            for (; j_ < n_free; j_++) {                                                           \
                int64_t stride_ = b->strides[free_at[j_]];                                        \
                from += stride_;                                                                  \
                if (++turn[j_] < values_of(p, b->fields.at[free_at[j_]])) break;                  \
                from -= turn[j_] * stride_, turn[j_] = 0;                                         \
            }                                                                                     \
            if (j_ == n_free) break;                                                              \
        }                                                                                         \
    }

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
        found[i] = b->goals[i] ? 0 : FAR;
        if (b->goals[i] && b->first[i + 1] > b->first[i] && !heap_push(&all->heap, (Entry){0, 0, i, 0})) return 0;
    }
    while (all->heap.count) {
        Entry entry = heap_pop(&all->heap);
        if (entry.key > found[entry.item]) continue;
        for (int32_t j = b->first[entry.item]; j < b->first[entry.item + 1]; j++) {
            Cost cost = entry.key + all->steps[b->class[j]];
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
        if (found[to] >= FAR) continue;
        for (int32_t j = b->first[to]; j < b->first[to + 1]; j++) {
            Cost drop = found[b->source[j]] - found[to];
            if (drop > all->steps[b->class[j]] && found[b->source[j]] < FAR) all->steps[b->class[j]] = drop;
        }
    }
    for (int32_t c = 0; c < b->n_classes; c++)
        for (int32_t j = b->members.start[c]; j < b->members.start[c + 1]; j++) needed[b->members.at[j]] = all->steps[c];
}

static int goal_state(const Problem *p, const Projection *b, int64_t number) {
    for (size_t i = b->fields.count; i-- > 0;) {
        const Field *field = &p->fields[b->fields.at[i]];
        int32_t value = (int32_t)(number / b->strides[i]);
        number -= value * b->strides[i];
        if (mentions(p->goal_mask, field) && (int32_t)code(p->goal, field) != value) return 0;
        for (int32_t j = 0; j < p->n_goal_forbidden; j++) {
            const Word *mask = p->goal_forbidden + 2 * (size_t)j * p->words;
            if (mentions(mask, field) && (int32_t)code(mask + p->words, field) == value) return 0;
        }
    }
    return 1;
}

/* Classes of operators and the transitions between states; 0: too many, or no memory. */
static int project(const Problem *p, Projection *b, int64_t most_transitions) {
    size_t k = b->fields.count;
    int32_t width = (int32_t)(2 * k), count = 0;
    int32_t *looks = malloc(((size_t)p->n_ops + 1) * (size_t)(width + 1) * sizeof *looks);
    int32_t **order = malloc(((size_t)p->n_ops + 1) * sizeof *order);
    int fine = looks && order;
    for (int32_t op = 0; fine && op < p->n_ops; op++) {
        int32_t *look = looks + (size_t)count * (size_t)(width + 1);
        seen(p, b, op, look, look + k);
        int changes = 0;
        for (size_t i = 0; i < k; i++) changes |= look[k + i] != NONE;
        look[width] = op;
        if (changes) order[count++] = look;
    }
    Ints which = {0}, member = {0}, source = {0}, class = {0}, target = {0};
    if (fine) {
        look_width = width;
        qsort(order, (size_t)count, sizeof *order, compare_looks);
    }
    for (int32_t i = 0; fine && i < count; i++) {
        if (!i || memcmp(order[i], order[i - 1], (size_t)width * sizeof(int32_t))) b->n_classes++;
        fine = ints_push(&which, b->n_classes - 1) && ints_push(&member, order[i][width]);
    }
    fine = fine && lists_of(&b->members, b->n_classes, &which, &member);
    int32_t c = NONE;
    for (int32_t i = 0; fine && i < count; i++) {
        if (i && !memcmp(order[i], order[i - 1], (size_t)width * sizeof(int32_t))) continue;
        c++;
        const int32_t *look = order[i];
        FOR_EACH_TRANSITION(look, k, {
            fine = ints_push(&source, (int32_t)from) && ints_push(&target, (int32_t)to) && ints_push(&class, c);
        })
        if ((int64_t)source.count > most_transitions) fine = 0;
    }
    b->first = calloc((size_t)b->n_states + 2, sizeof *b->first);
    b->source = malloc((source.count + 1) * sizeof *b->source), b->class = malloc((source.count + 1) * sizeof *b->class);
    fine = fine && b->first && b->source && b->class;
    if (fine) {
        for (size_t i = 0; i < target.count; i++) b->first[target.at[i] + 1]++;
        for (int32_t i = 0; i < b->n_states; i++) b->first[i + 1] += b->first[i];
        for (size_t i = target.count; i-- > 0;) {
            int32_t place = --b->first[target.at[i] + 1];
            b->source[place] = source.at[i], b->class[place] = class.at[i];
        }
        /* first[t + 1] went down to where the transitions of t begin */
        memmove(b->first, b->first + 1, (size_t)b->n_states * sizeof *b->first);
        b->first[b->n_states] = (int32_t)source.count;
    }
    free(looks), free(order), free(which.at), free(member.at), free(source.at), free(class.at), free(target.at);
    return fine;
}

/* Tables of one order, best first for a state: each takes what it needs of the weights and leaves the rest. */
static int partition(Projections *all, const Problem *p, const Word *state, Cost **tables) {
    int32_t *order = malloc(((size_t)all->count + 1) * sizeof *order);
    double *worth = malloc(((size_t)all->count + 1) * sizeof *worth);
    int fine = order && worth;
    for (int32_t i = 0; fine && i < all->count; i++) {
        double value = (double)all->at[i].alone[number_of(p, &all->at[i], state)] / (all->at[i].taken + 1);
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

static Cost summed(const Projections *all, Cost *const *tables) {
    Cost sum = 0;
    for (int32_t i = 0; i < all->count; i++) {
        if (!tables[i]) continue;
        Cost value = tables[i][all->number[i]];
        if (value >= FAR) return INFINITE_COST;
        sum += value;
    }
    return sum;
}

static Cost projected(const Projections *all, const Problem *p, const Word *state) {
    for (int32_t i = 0; i < all->count; i++) all->number[i] = number_of(p, &all->at[i], state);
    Cost best = 0;
    for (int32_t order = 0; order < all->n_orders; order++) {
        Cost sum = summed(all, all->tables + (size_t)order * all->count);
        if (sum > best) best = sum;
        if (sum == INFINITE_COST) break;
    }
    return best;
}

static void projections_free(Projections *all) {
    for (int32_t i = 0; i < all->count * all->n_orders; i++) free(all->tables[i]);
    for (int32_t i = 0; i < all->count; i++) projection_free(&all->at[i]);
    free(all->at), free(all->tables), free(all->samples), free(all->best), free(all->number), free(all->heap.at);
    free(all->left), free(all->needed), free(all->steps), free(all->found);
}

/* ---- strong stubborn sets ---- */

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
    if (!b->words || applicable->count < 2) return;
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

/* ---- optimal search ---- */

enum { TRIALS = 500, SELDOM = 20 };
enum { RUNNING, FOUND, NOT_BELOW, HOPELESS, MEMORY };

typedef struct {
    Problem problem;
    Table table;
    Relaxed relaxed;
    Projections projections;
    Stubborn stubborn;
    /* how often LM-cut was asked, by turns, said more than what was known, and was not asked */
    int64_t asked[N_TURNS], raised[N_TURNS], skipped[N_TURNS];
    Heap heap;
    Ints applicable, closed, fresh;
    Word *row;
    const Word *rests_of; /* the state whose landmarks `rests` is about */
    Cost *rests;          /* per relaxed operator what is left after it; last: after those that are no relaxed ones */
    Cost limit, least; /* nothing from the limit on is of interest; no plan is cheaper than least */
    uint32_t stamp;
    int32_t start, end;
    int cut_off; /* whether something was left out because of the limit */
    int64_t expanded, generated, evaluated;
    /* greedy search */
    Table met;
    Heap all, chosen;
    Cost best_rest;
    int64_t turn_all, turn_chosen;
    int32_t serial, turn, goal;
} Planner;

static void look_up(const Planner *s, Node *node, const Word *state) {
    if (node->projected || !s->projections.n_orders) return;
    node->projected = 1;
    Cost rest = projected(&s->projections, &s->problem, state);
    if (rest > node->rest) node->rest = rest;
    if (rest == INFINITE_COST) node->exact = 1;
}

/* Whether it is worth asking: one that seldom said more is asked now and then only. */
static int pays(Planner *s, int32_t turn) {
    return s->asked[turn] < TRIALS || s->raised[turn] * SELDOM >= s->asked[turn] || !(s->skipped[turn]++ % SELDOM);
}

/* What is left after each operator, at least: of the landmarks of LM-cut those that it is not in. */
static void keep_rests(Planner *s, const Word *state, Cost total) {
    const RelaxedProblem *x = &s->relaxed.problem;
    if (s->rests_of != state) {
        for (int32_t o = 0; o <= x->n_ops; o++) s->rests[o] = 0;
        s->rests_of = state;
    }
    for (int32_t o = 0; o < x->n_ops; o++) {
        Cost rest = total - x->weight[o] + s->relaxed.ops[o].cost;
        if (rest > s->rests[o]) s->rests[o] = rest;
    }
    if (total > s->rests[x->n_ops]) s->rests[x->n_ops] = total;
}

static void evaluate(Planner *s, Node *node, const Word *state) {
    int32_t turn = node->evaluated++;
    if (node->exact || turn >= N_TURNS || (turn && !pays(s, turn))) return;
    s->evaluated++, s->asked[turn]++;
    Cost rest = lm_cut(&s->relaxed, &s->problem, state, turn);
    if (rest > node->rest) node->rest = rest, s->raised[turn]++;
    if (rest == INFINITE_COST) {
        node->exact = 1;
        return;
    }
    keep_rests(s, state, rest);
}

static void open_node(Planner *s, int32_t id) {
    const Node *node = node_of(&s->table, id);
    if (node->rest == INFINITE_COST) return;
    Cost total = node->spent + node->rest;
    if (total >= s->limit) {
        s->cut_off = 1;
        return;
    }
    heap_push(&s->heap, (Entry){total, node->rest, id, s->serial++});
}

/* What is learnt of the states that were expanded: from none of them is a plan cheaper than total - spent. */
static void learn(Planner *s, Cost total) {
    for (size_t i = 0; i < s->closed.count; i++) {
        Node *node = node_of(&s->table, s->closed.at[i]);
        if (node->exact) continue;
        if (total == INFINITE_COST) {
            node->rest = INFINITE_COST, node->exact = 1;
        } else if (total - node->spent > node->rest) {
            node->rest = total - node->spent;
        }
    }
}

static int finish(Planner *s, int outcome, Cost total) {
    learn(s, total);
    s->least = total;
    if (outcome == FOUND) {
        Cost rest = node_of(&s->table, s->end)->rest;
        for (int32_t id = s->end;;) {
            Node *node = node_of(&s->table, id);
            node->rest = rest, node->exact = 1;
            if (id == s->start) break;
            rest += s->problem.weight[node->op];
            id = node->parent;
        }
    }
    return outcome;
}

API int planner_begin(Planner *s, const Word *state, Cost limit, size_t allowed) {
    s->least = 0;
    s->table.allowed = allowed;
    if (!reserve(&s->table, 1)) return MEMORY;
    int is_new;
    s->start = find(&s->table, state, &is_new);
    Node *node = node_of(&s->table, s->start);
    if (is_new) look_up(s, node, state);
    s->heap.count = s->closed.count = 0;
    s->limit = limit, s->cut_off = 0, s->least = 0, s->serial = 0;
    s->stamp++;
    node->stamp = s->stamp, node->spent = 0, node->closed = 0, node->parent = NONE, node->op = NONE;
    open_node(s, s->start);
    return RUNNING;
}

static void expand(Planner *s, int32_t id) {
    const Problem *p = &s->problem;
    Node *node = node_of(&s->table, id);
    const Word *state = state_of(&s->table, id);
    int fresh = s->rests_of == state;
    node->closed = 1;
    ints_push(&s->closed, id);
    s->expanded++;
    successors(p, state, &s->applicable);
    leave_stubborn(&s->stubborn, p, &s->table, state, &s->applicable);
    for (size_t i = 0; i < s->applicable.count; i++) {
        int32_t op = s->applicable.at[i];
        size_t row = (size_t)op * p->words;
        for (int32_t w = 0; w < p->words; w++) s->row[w] = (state[w] & p->keep[row + w]) | p->put[row + w];
        int is_new;
        int32_t next = find(&s->table, s->row, &is_new);
        Node *after = node_of(&s->table, next);
        s->generated++;
        Cost spent = node->spent + p->weight[op];
        if (is_new) look_up(s, after, s->row);
        if (after->stamp == s->stamp && after->spent <= spent) continue;
        after->stamp = s->stamp, after->spent = spent, after->parent = id, after->op = op, after->closed = 0;
        if (!after->exact) {
            Cost rest = node->rest - p->weight[op];
            int32_t class = s->relaxed.problem.class_of[op];
            Cost known = !fresh ? 0 : s->rests[class == NONE ? s->relaxed.problem.n_ops : class];
            if (known > rest) rest = known;
            if (after->rest < rest) after->rest = rest;
        }
        open_node(s, next);
    }
}

API int planner_run(Planner *s, double seconds, size_t allowed) {
    double end = now() + seconds;
    s->table.allowed = allowed;
    while (s->heap.count) {
        Entry entry = s->heap.at[0];
        Node *node = node_of(&s->table, entry.item);
        if (node->closed || entry.key != node->spent + node->rest) {
            heap_pop(&s->heap);
            continue;
        }
        if (entry.key > s->least) s->least = entry.key;
        if (now() >= end) return RUNNING;
        const Word *state = state_of(&s->table, entry.item);
        if (!node->exact && is_goal(&s->problem, state)) node->rest = 0, node->exact = 1;
        if (node->exact && node->spent + node->rest == entry.key) {
            s->end = entry.item;
            return finish(s, FOUND, entry.key);
        }
        look_up(s, node, state);
        if (node->evaluated < N_TURNS && node->rest < INFINITE_COST && node->spent + node->rest == entry.key)
            evaluate(s, node, state);
        if (node->rest == INFINITE_COST || node->spent + node->rest != entry.key) {
            heap_pop(&s->heap);
            open_node(s, entry.item);
            continue;
        }
        if (node->evaluated < N_TURNS) continue;
        size_t more = (size_t)s->problem.n_ops + 1;
        if (!reserve(&s->table, (int32_t)more) || !heap_reserve(&s->heap, more, &s->table)) return MEMORY;
        heap_pop(&s->heap);
        expand(s, entry.item);
    }
    return s->cut_off ? finish(s, NOT_BELOW, s->limit) : finish(s, HOPELESS, INFINITE_COST);
}

/* Lower bound from a state, and whether it is exact; -1 where memory is missing. */
API Cost planner_bound(Planner *s, const Word *asked, size_t allowed) {
    s->table.allowed = allowed;
    if (!reserve(&s->table, 1)) return -1;
    int is_new;
    int32_t id = find(&s->table, asked, &is_new);
    Node *node = node_of(&s->table, id);
    const Word *state = state_of(&s->table, id);
    if (is_new) look_up(s, node, state);
    if (!node->evaluated && node->rest < INFINITE_COST) evaluate(s, node, state);
    return node->rest;
}

API Cost planner_least(const Planner *s) { return s->least; }
API size_t planner_wanted(const Planner *s) { return s->table.wanted > s->met.wanted ? s->table.wanted : s->met.wanted; }
API void planner_counts(const Planner *s, int64_t *counts) {
    counts[0] = s->expanded, counts[1] = s->generated, counts[2] = s->evaluated;
}

/* The operators of the way that was found, from its end back to the start; how many. */
API int32_t planner_way(const Planner *s, int greedy, int32_t *ops, int32_t room) {
    const Table *t = greedy ? &s->met : &s->table;
    int32_t count = 0;
    for (int32_t id = greedy ? s->goal : s->end; node_of(t, id)->parent != NONE; id = node_of(t, id)->parent) {
        if (count < room) ops[count] = node_of(t, id)->op;
        count++;
    }
    return count;
}

/* ---- greedy search ---- */

API int planner_begin_greedy(Planner *s, const Word *state, size_t allowed) {
    table_free(&s->met);
    memset(&s->met, 0, sizeof s->met);
    s->met.words = s->problem.words, s->met.allowed = allowed;
    if (!reserve(&s->met, 1)) return MEMORY;
    s->all.count = s->chosen.count = 0, s->serial = 0, s->turn_all = s->turn_chosen = 0;
    s->best_rest = INFINITE_COST, s->goal = NONE;
    int is_new;
    int32_t id = find(&s->met, state, &is_new);
    Node *node = node_of(&s->met, id);
    node->parent = NONE, node->op = NONE;
    heap_push(&s->all, (Entry){0, 0, id, 0});
    return RUNNING;
}

static void expand_greedily(Planner *s, int32_t id, Cost rest) {
    const Problem *p = &s->problem;
    const Word *state = state_of(&s->met, id);
    for (size_t i = 0; i < s->fresh.count; i++) s->relaxed.chosen[s->fresh.at[i]] = 1;
    successors(p, state, &s->applicable);
    for (size_t i = 0; i < s->applicable.count; i++) {
        int32_t op = s->applicable.at[i];
        size_t row = (size_t)op * p->words;
        for (int32_t w = 0; w < p->words; w++) s->row[w] = (state[w] & p->keep[row + w]) | p->put[row + w];
        int is_new;
        int32_t next = find(&s->met, s->row, &is_new);
        if (!is_new) continue;
        Node *after = node_of(&s->met, next);
        after->parent = id, after->op = op, after->spent = node_of(&s->met, id)->spent + p->weight[op];
        Entry entry = {rest, after->spent, next, -s->serial++};
        heap_push(&s->all, entry);
        int32_t class = s->relaxed.problem.class_of[op];
        if (class != NONE && s->relaxed.chosen[class]) heap_push(&s->chosen, entry);
    }
    for (size_t i = 0; i < s->fresh.count; i++) s->relaxed.chosen[s->fresh.at[i]] = 0;
}

API int planner_run_greedy(Planner *s, double seconds, size_t allowed) {
    double end = now() + seconds;
    s->met.allowed = allowed;
    while (s->all.count || s->chosen.count) {
        if (now() >= end) return RUNNING;
        size_t more = (size_t)s->problem.n_ops + 1;
        if (!reserve(&s->met, (int32_t)more) || !heap_reserve(&s->all, more, &s->met) ||
            !heap_reserve(&s->chosen, more, &s->met))
            return MEMORY;
        int preferred = s->chosen.count && (!s->all.count || s->turn_chosen <= s->turn_all);
        Entry entry = heap_pop(preferred ? &s->chosen : &s->all);
        if (preferred) s->turn_chosen++; else s->turn_all++;
        Node *node = node_of(&s->met, entry.item);
        if (node->closed) continue;
        node->closed = 1;
        const Word *state = state_of(&s->met, entry.item);
        if (is_goal(&s->problem, state)) {
            s->goal = entry.item;
            return FOUND;
        }
        s->fresh.count = 0;
        Cost rest = relaxed_plan(&s->relaxed, &s->problem, state, &s->fresh);
        s->evaluated++;
        if (rest == INFINITE_COST) continue;
        if (rest < s->best_rest) s->best_rest = rest, s->turn_chosen -= 1000;
        expand_greedily(s, entry.item, rest);
    }
    return HOPELESS;
}

/* ---- making and freeing ---- */

typedef struct {
    int32_t words, n_ops, n_fields, n_facts, n_forbidden, n_goal_forbidden;
    const Word *need_mask, *need, *keep, *put;
    const int32_t *forbidding; /* per forbidden literal its operator, ascending */
    const Word *forbidden;
    const Cost *weight;
    const int32_t *fields; /* three numbers each */
    const Word *goal_mask, *goal, *goal_forbidden;
} Spec;

API void planner_free(Planner *s) {
    if (!s) return;
    Problem *p = &s->problem;
    free(p->need_mask), free(p->need), free(p->keep), free(p->put), free(p->forbidden), free(p->weight);
    free(p->fields), free(p->goal_mask), free(p->goal), free(p->goal_forbidden);
    lists_free(&p->forbids), free(p->tree.at);
    relaxed_free(&s->relaxed), stubborn_free(&s->stubborn, p->n_ops);
    table_free(&s->table), table_free(&s->met);
    projections_free(&s->projections);
    free(s->heap.at), free(s->all.at), free(s->chosen.at);
    free(s->applicable.at), free(s->closed.at), free(s->fresh.at), free(s->row), free(s->rests);
    free(s);
}

API Planner *planner_new(const Spec *spec) {
    Planner *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    Problem *p = &s->problem;
    size_t row = (size_t)spec->words * sizeof(Word), ops = (size_t)spec->n_ops;
    p->words = spec->words, p->n_ops = spec->n_ops, p->n_fields = spec->n_fields, p->n_facts = spec->n_facts;
    p->n_forbidden = spec->n_forbidden, p->n_goal_forbidden = spec->n_goal_forbidden;
    p->need_mask = copied(spec->need_mask, ops * row), p->need = copied(spec->need, ops * row);
    p->keep = copied(spec->keep, ops * row), p->put = copied(spec->put, ops * row);
    p->forbidden = copied(spec->forbidden, 2 * row * (size_t)spec->n_forbidden);
    p->weight = copied(spec->weight, ops * sizeof(Cost));
    p->fields = copied(spec->fields, (size_t)spec->n_fields * sizeof(Field));
    p->goal_mask = copied(spec->goal_mask, row), p->goal = copied(spec->goal, row);
    p->goal_forbidden = copied(spec->goal_forbidden, 2 * row * (size_t)spec->n_goal_forbidden);
    s->table.words = s->met.words = spec->words;
    s->row = malloc(row), s->applicable.at = malloc((ops + 1) * sizeof(int32_t));
    int fine = p->need_mask && p->need && p->keep && p->put && p->forbidden && p->weight && p->fields && p->goal_mask &&
               p->goal && p->goal_forbidden && s->row && s->applicable.at;
    Ints which = {0}, number = {0};
    for (int32_t i = 0; fine && i < spec->n_forbidden; i++)
        fine = ints_push(&which, spec->forbidding[i]) && ints_push(&number, i);
    fine = fine && lists_of(&p->forbids, p->n_ops, &which, &number) && relaxed_new(&s->relaxed, p);
    fine = fine && stubborn_new(&s->stubborn, p);
    fine = fine && (s->rests = malloc(((size_t)s->relaxed.problem.n_ops + 1) * sizeof(Cost)));
    if (fine && p->n_ops) {
        which.count = 0;
        for (int32_t o = 0; fine && o < p->n_ops; o++) fine = ints_push(&which, o);
        char *done = calloc((size_t)p->n_fields + 1, 1);
        fine = fine && done && plant(p, which.at, p->n_ops, done) != NONE;
        free(done);
    }
    free(which.at), free(number.at);
    if (fine) return s;
    planner_free(s);
    return NULL;
}

/* Another pattern, given by the numbers of its fields, ascending: how many transitions it has, -1 where there are
   more than allowed, -2 where memory is missing.  Not once there is an order. */
API int64_t planner_pattern(Planner *s, const int32_t *fields, int32_t count, int64_t most_transitions) {
    Projections *all = &s->projections;
    const Problem *p = &s->problem;
    if (all->count == all->room) {
        int32_t room = all->room ? 2 * all->room : 16;
        Projection *at = realloc(all->at, (size_t)room * sizeof *at);
        if (!at) return -2;
        all->at = at, all->room = room;
    }
    Projection *b = &all->at[all->count];
    memset(b, 0, sizeof *b);
    b->strides = malloc(((size_t)count + 1) * sizeof *b->strides);
    int64_t size = 1;
    int fine = b->strides != NULL;
    for (int32_t i = 0; fine && i < count; i++) {
        b->strides[i] = size, size *= values_of(p, fields[i]);
        fine = ints_push(&b->fields, fields[i]);
    }
    b->n_states = (int32_t)size;
    if (!fine || !project(p, b, most_transitions)) {
        projection_free(b);
        return -1;
    }
    b->goals = malloc((size_t)size), b->alone = malloc((size_t)size * sizeof(Cost));
    Cost *needed = realloc(all->needed, ((size_t)p->n_ops + 1) * sizeof(Cost));
    if (needed) all->needed = needed;
    Cost *left = realloc(all->left, ((size_t)p->n_ops + 1) * sizeof(Cost));
    if (left) all->left = left;
    Cost *steps = realloc(all->steps, ((size_t)p->n_ops + 1) * sizeof(Cost));
    if (steps) all->steps = steps;
    fine = b->goals && b->alone && needed && left && steps;
    for (int64_t i = 0; fine && i < size; i++) b->goals[i] = (uint8_t)goal_state(p, b, i);
    if (!fine || !distances(all, b, p->weight, b->alone)) {
        projection_free(b);
        return -2;
    }
    saturate(all, b, b->alone, all->needed, p->n_ops);
    for (int32_t o = 0; o < p->n_ops; o++) b->taken += (double)all->needed[o];
    all->count++;
    return b->first[b->n_states];
}

/* States for which orders are chosen, the start and others that were met: how many, or -2. */
API int planner_samples(Planner *s, int32_t most) {
    Projections *all = &s->projections;
    int32_t states = 1, count = s->table.count < most ? s->table.count : most;
    for (int32_t i = 0; i < all->count; i++) states = all->at[i].n_states > states ? all->at[i].n_states : states;
    size_t row = (size_t)s->problem.words;
    all->n_samples = count;
    all->samples = malloc(((size_t)count + 1) * row * sizeof(Word));
    all->best = malloc(((size_t)count + 1) * sizeof(Cost));
    all->found = malloc((size_t)states * sizeof(Cost));
    all->number = malloc(((size_t)all->count + 1) * sizeof *all->number);
    if (!all->samples || !all->best || !all->found || !all->number) return -2;
    for (int32_t i = 0; i < count; i++) {
        int32_t id = i ? (int32_t)((int64_t)i * s->table.count / count) : s->start;
        memcpy(all->samples + (size_t)i * row, state_of(&s->table, id), row * sizeof(Word));
        all->best[i] = -1;
    }
    return count;
}

/* The order that is made for a sample: 1 where it says more of some sample than those before, and is kept. */
API int planner_order(Planner *s, int32_t sample) {
    Projections *all = &s->projections;
    const Problem *p = &s->problem;
    size_t count = (size_t)all->count;
    Cost **tables = realloc(all->tables, ((size_t)all->n_orders + 1) * count * sizeof *tables);
    if (!tables) return -2;
    all->tables = tables;
    tables += (size_t)all->n_orders * count;
    memset(tables, 0, count * sizeof *tables);
    int better = 0, fine = partition(all, p, all->samples + (size_t)sample * p->words, tables);
    for (int32_t i = 0; fine && i < all->n_samples; i++) {
        const Word *state = all->samples + (size_t)i * p->words;
        for (int32_t j = 0; j < all->count; j++) all->number[j] = number_of(p, &all->at[j], state);
        Cost value = summed(all, tables);
        if (value > all->best[i]) all->best[i] = value, better = 1;
    }
    if (better) {
        all->n_orders++;
        return 1;
    }
    for (size_t i = 0; i < count; i++) free(tables[i]);
    return fine ? 0 : -2;
}
