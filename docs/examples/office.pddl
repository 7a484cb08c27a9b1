(define (domain office)
  (:requirements :strips :typing)
  (:types person robot - agent
          agent place key - object)
  (:predicates (path ?a ?b - place) (door ?a ?b - place) (open ?b - place)
               (at ?who - agent ?where - place) (lies ?what - key ?where - place)
               (holds ?who - agent ?what - key) (archive ?where - place) (filed))
  (:action walk
    :parameters (?who - agent ?a ?b - place)
    :precondition (and (at ?who ?a) (path ?a ?b))
    :effect (and (at ?who ?b) (not (at ?who ?a))))
  (:action take
    :parameters (?who - agent ?what - key ?where - place)
    :precondition (and (at ?who ?where) (lies ?what ?where))
    :effect (and (holds ?who ?what) (not (lies ?what ?where))))
  (:action unlock
    :parameters (?who - agent ?with - key ?a ?b - place)
    :precondition (and (at ?who ?a) (door ?a ?b) (holds ?who ?with))
    :effect (open ?b))
  (:action enter
    :parameters (?who - agent ?a ?b - place)
    :precondition (and (at ?who ?a) (door ?a ?b) (open ?b))
    :effect (and (at ?who ?b) (not (at ?who ?a))))
  (:action file
    :parameters (?who - person ?where - place)
    :precondition (and (at ?who ?where) (archive ?where))
    :effect (filed)))
