(define (domain cart)
  (:types bed can)
  (:predicates (path ?from ?to - bed) (at-robo ?b - bed) (loaded ?c - can) (lies ?c - can ?b - bed))
  (:action walk
    :parameters (?from ?to - bed)
    :precondition (and (at-robo ?from) (path ?from ?to))
    :effect (and (not (at-robo ?from)) (at-robo ?to)))
  (:action load
    :parameters (?c - can ?b - bed)
    :precondition (and (at-robo ?b) (lies ?c ?b))
    :effect (and (loaded ?c) (not (lies ?c ?b))))
  (:action unload
    :parameters (?c - can ?b - bed)
    :precondition (and (at-robo ?b) (loaded ?c))
    :effect (and (lies ?c ?b) (not (loaded ?c)))))
