; Taxis take guests through a town with narrow squares: a taxi fits only where no other stands.
(define (domain taxis)
  (:requirements :strips :typing :multi-agent)
  (:types place person - object
          taxi guest - person)
  (:predicates (street ?a ?b - place) (at ?who - person ?where - place) (room ?where - place)
               (seat ?car - taxi) (in ?who - guest ?car - taxi))
  (:action drive
    :agent ?car - taxi
    :parameters (?from ?to - place)
    :precondition (and (at ?car ?from) (street ?from ?to) (room ?to))
    :effect (and (at ?car ?to) (room ?from) (not (at ?car ?from)) (not (room ?to))))
  (:action pick-up
    :agent ?car - taxi
    :parameters (?who - guest ?where - place)
    :precondition (and (at ?car ?where) (at ?who ?where) (seat ?car))
    :effect (and (in ?who ?car) (not (at ?who ?where)) (not (seat ?car))))
  (:action set-down
    :agent ?car - taxi
    :parameters (?who - guest ?where - place)
    :precondition (and (at ?car ?where) (in ?who ?car))
    :effect (and (at ?who ?where) (seat ?car) (not (in ?who ?car)))))
