(define (problem random)
  (:domain grounded)
  (:init
    (= (total-cost) 0)
  )
  (:goal (and (f2)))
  (:metric minimize (total-cost))
)
