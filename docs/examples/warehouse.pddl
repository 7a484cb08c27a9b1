(define (domain warehouse)
  (:requirements :strips :typing)
  (:types person lift - agent
          agent place - object)
  (:predicates (path ?a ?b - place) (free ?where - place) (at ?who - agent ?where - place)
               (pair ?one ?other - lift) (signed))
  (:action walk
    :parameters (?who - agent ?a ?b - place)
    :precondition (and (at ?who ?a) (path ?a ?b) (free ?b))
    :effect (and (at ?who ?b) (not (at ?who ?a))))
  (:action clear
    :parameters (?one ?other - lift ?from ?where - place)
    :precondition (and (pair ?one ?other) (at ?one ?from) (at ?other ?from) (path ?from ?where))
    :effect (free ?where))
  (:action sign
    :parameters (?who - person)
    :precondition (at ?who dock)
    :effect (signed))
  (:constants dock - place))
