/* The binary heap: entries by key, then by a second key, the latest first.

   Source: Williams, Algorithm 232 (1964). */

#pragma once

#include <stdlib.h>
#include "values.h"

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
