(define (domain kitchen)
  (:requirements :strips :typing :action-costs)
  (:types person robot - agent
          agent place - object)
  (:predicates (path ?a ?b - place) (at ?who - agent ?where - place) (oven-at ?where - place)
               (flour-at ?where - place) (table-at ?where - place)
               (flour ?who - agent) (dough ?who - agent) (hot) (bread))
  (:functions (total-cost) - number)
  (:action walk
    :parameters (?who - agent ?a ?b - place)
    :precondition (and (at ?who ?a) (path ?a ?b))
    :effect (and (at ?who ?b) (not (at ?who ?a)) (increase (total-cost) 1)))
  (:action fetch
    :parameters (?who - person ?where - place)
    :precondition (and (at ?who ?where) (flour-at ?where))
    :effect (and (flour ?who) (increase (total-cost) 1)))
  (:action knead
    :parameters (?who - person ?where - place)
    :precondition (and (at ?who ?where) (table-at ?where) (flour ?who))
    :effect (and (dough ?who) (not (flour ?who)) (increase (total-cost) 2)))
  (:action heat
    :parameters (?who - agent ?where - place)
    :precondition (and (at ?who ?where) (oven-at ?where))
    :effect (and (hot) (increase (total-cost) 3)))
  (:action bake
    :parameters (?who - person ?where - place)
    :precondition (and (at ?who ?where) (oven-at ?where) (dough ?who) (hot))
    :effect (and (bread) (not (dough ?who)) (increase (total-cost) 1))))
