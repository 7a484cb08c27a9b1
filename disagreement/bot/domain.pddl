(define (domain grounded)
  (:requirements :strips :negative-preconditions :action-costs)
  (:predicates
    (f1)
    (f3)
    (f0)
  )
  (:functions (total-cost))
  (:action aid0_bot
    :parameters ()
    :precondition (and (not (f3)))
    :effect (and (increase (total-cost) (/ 5 2)) (f1)))
  (:action aid1_bot
    :parameters ()
    :precondition (and )
    :effect (and (increase (total-cost) 1) (f0)))
)
