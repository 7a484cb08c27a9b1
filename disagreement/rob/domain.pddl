(define (domain grounded)
  (:requirements :strips :negative-preconditions :action-costs)
  (:predicates
  )
  (:functions (total-cost))
)
