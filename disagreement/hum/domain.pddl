(define (domain grounded)
  (:requirements :strips :negative-preconditions :action-costs)
  (:predicates
    (f1)
    (f3)
    (f2)
  )
  (:functions (total-cost))
  (:action do0_hum
    :parameters ()
    :precondition (and )
    :effect (and (increase (total-cost) (/ 5 2)) (f1)))
  (:action do2_hum
    :parameters ()
    :precondition (and )
    :effect (and (increase (total-cost) (/ 1 2)) (f2)))
  (:action do3_hum
    :parameters ()
    :precondition (and )
    :effect (and (increase (total-cost) (/ 1 2)) (f3)))
)
