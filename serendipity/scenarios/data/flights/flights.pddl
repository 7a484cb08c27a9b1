; Ada flies ann to the harbour, and has to refuel there before she can fetch bob from the island.
(define (problem flights)
  (:domain flights)
  (:objects ada kite - aircraft
            ann bob - passenger
            high middle low none - level
            capital harbour island ridge - airport)
  (:init (route capital harbour) (route harbour capital) (route harbour island) (route island harbour)
         (route island ridge) (route ridge island)
         (pump harbour) (full high) (next high middle) (next middle low) (next low none)
         (at ada capital) (fuel ada middle) (at kite ridge) (fuel kite middle)
         (at ann capital) (at bob island))
  (:goal (and (at ann harbour) (at bob capital)))
  (:metric minimize (total-cost)))
