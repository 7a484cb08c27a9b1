(define (problem night-shift)
  (:domain wards)
  (:objects eva - nurse carta cartb - cart
            store w1 w2 w3 w4 w5 w6 w7 w8 w9 w10 - place
            sheet1 sheet2 - sheet aspirin - drug
            mila noah - patient)
  (:init (at eva w1) (at carta store) (at cartb w9) (= (total-cost) 0)
         (door store w1) (door w1 w2) (door w2 w3) (door w3 w4) (door w4 w5)
         (door w5 w6) (door w6 w7) (door w7 w8) (door w8 w9) (door w9 w10)
         (lies sheet1 store) (lies sheet2 w10) (stocked aspirin) (cabinet store)
         (wet w6) (in-bed mila w6) (in-bed noah w2) (= (weight mila) 6) (= (weight noah) 4))
  (:goal (and (forall (?p - place) (not (wet ?p))) (fresh w6) (treated mila))))
