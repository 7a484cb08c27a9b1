(define (domain together)
  (:requirements :typing :action-costs)
  (:types bed can agent)
  (:constants anna robo - agent)
  (:predicates (at-anna ?b - bed) (at-robo ?b - bed) (anna-holds ?c - can) (loaded ?c - can))
  (:functions (total-cost))
  (:action walk
    :parameters (?from ?to - bed)
    :precondition (at-anna ?from)
    :effect (and (not (at-anna ?from)) (at-anna ?to) (increase (total-cost) 100)))
  (:action lift_down_robo_anna
    :parameters (?c - can ?b - bed)
    :precondition (and (at-anna ?b) (at-robo ?b) (loaded ?c))
    :effect (and (anna-holds ?c) (not (loaded ?c)) (increase (total-cost) 1)))
  (:action greet
    :parameters (?a ?b - agent ?where - bed)
    :precondition (and (at-anna ?where) (at-robo ?where) (not (= ?a ?b)))
    :effect (and (at-anna ?where) (increase (total-cost) 0))))
