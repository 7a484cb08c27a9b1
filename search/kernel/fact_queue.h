/* A priority queue of facts for exploring the delete relaxation: a list for each cost, as there are few of them. */

#pragma once

#include <string.h>
#include "values.h"

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
