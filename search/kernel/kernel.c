/* Classical planning over packed states: optimal search with admissible bounds, greedy search for a first plan.

   A state is a row of 64-bit words, the same bits as the Python int of search/packed; an operator is four such
   rows, so what is compiled here and what Python does are one and the same arithmetic.  Nothing here knows of
   agents, epochs or windows.

   This file is all that is compiled, so that the compiler sees the whole at once.  What it is made of includes what it
   stands on, from the top:

     api                                   what Python calls
     epochs, epoch_ways                    states epoch by epoch, with agents at a time; how each is come by
     a_star, greedy_search                 the searches
     learning, evaluation, stubborn_sets   what A* learns of states; bounds of nodes; which operators it leaves out
     lm_cut, relaxed_plan                  bounds and first steps from the delete relaxation: LM-cut, FF
     landmarks                             what LM-cut has found of states, for those after them
     relaxation, relaxed_problem           the problem without deletes, explored from a state
     fact_queue                            facts that wait meanwhile
     state_table, successor_generator      states that were met; applicable operators
     like_fields                           states that stand for others
     problem, heap, lists, values          operators, costs and goal; what all are made of */

#ifndef _WIN32
#define _POSIX_C_SOURCE 199309L /* for clock_gettime */
#endif

#include "api.h"

#ifndef KERNEL_SOURCE_HASH
#define KERNEL_SOURCE_HASH ""
#endif

API const char *kernel_source_hash(void) { return KERNEL_SOURCE_HASH; }
