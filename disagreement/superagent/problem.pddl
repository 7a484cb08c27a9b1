(define (problem random)
  (:domain grounded)
  (:init
    (= (total-cost) 0)
  )
  (:goal (and (f0)))
  (:metric minimize (total-cost))
)
