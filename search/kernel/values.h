/* Words of states, costs, how a slice of a search ends, and the clock that slices are measured by. */

#pragma once

#include <stdint.h>
#include <time.h>

typedef uint64_t Word;
typedef int64_t Cost;

#define INFINITE_COST INT64_MAX
#define NONE (-1)

/* How a slice of a search ends. */
enum { RUNNING, FOUND, NOT_BELOW, HOPELESS, MEMORY };

static double now(void) {
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
