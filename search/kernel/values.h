/* Words of states, costs, how a slice of a search ends, and the clock that slices are measured by. */

#pragma once

#include <stdint.h>
#include <time.h>

typedef uint64_t Word;
typedef int64_t Cost;

#define INFINITE_COST INT64_MAX /* there is no way; nothing that can be had costs as much, see MOST_COST */
#define NONE (-1)

/* Where costs end.  Python sees to it that those of all operators together are below it (search/classical/problem.py), so
   what counts an operator once at most is.  Other sums are made by `plus`: as bounds they stay admissible; a way that costs
   as much is left out, and the search says so (UNFIT). */
#define MOST_COST ((Cost)1 << 61)

/* How a slice of a search ends; UNFIT: what is asked for may cost more than there is room for. */
enum { RUNNING, FOUND, NOT_BELOW, HOPELESS, MEMORY, UNFIT };

/* What A* can be told to leave out, added up, so that it is seen what each is good for; answers stay. */
enum { HANDED_DOWN = 1, SECOND_CUTS = 2, THIRD_CUTS = 4, STUBBORN_SETS = 8, LOOKAHEAD = 16, LIKE_FIELDS = 32 };
static int left_out;

/* A sum of costs that are MOST_COST at most. */
static inline Cost plus(Cost a, Cost b) { return a + b < MOST_COST ? a + b : MOST_COST; }

/* Seconds by a clock that nobody sets; standard C has only that of processor time, which asks the system for a microsecond. */
static double now(void) {
#ifdef CLOCK_MONOTONIC
    struct timespec time;
    if (!clock_gettime(CLOCK_MONOTONIC, &time)) return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
#endif
    return (double)clock() / CLOCKS_PER_SEC;
}
