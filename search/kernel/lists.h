/* Lists of numbers: growing ones, and many lists one after another. */

#pragma once

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
