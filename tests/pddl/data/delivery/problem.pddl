(define (problem parcels) (:domain delivery)
(:objects a b - place p - parcel
  (:private v v - van)
  (:private w w - bike s - parcel)
  (:private x x - bike))
(:init (is v a) (is w b) (is x b) (at p a) (road a b) (road b a) (= (far a b) 2) (= (far b a) 3))
(:goal (has w p)) (:metric minimize (total-cost)))
