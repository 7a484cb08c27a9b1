(define (problem cart-at-the-shed)
  (:domain cart)
  (:objects kale shed - bed can1 - can)
  (:init (path shed kale) (path kale shed) (at-robo shed) (lies can1 shed)))
