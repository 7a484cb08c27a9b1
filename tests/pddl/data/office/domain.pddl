; One task; the agents are objects.  Some objects are named like keywords and types.
(define (domain office)
  (:requirements :typing :equality :negative-preconditions :action-costs)
  (:types room thing agent - object
          lift - room)
  (:constants basement - lift)
  (:predicates
    (door ?a ?b - room)
    (at ?who - agent ?where - room)
    (in ?what - thing ?where - room)
    (has ?who - agent ?what - thing)
    (broken ?where - lift)
    (read ?what - thing))
  (:functions (total-cost) (steps ?to - room))
  (:action move
    :parameters (?who - agent ?from ?to - room)
    :precondition (and (at ?who ?from) (door ?from ?to))
    :effect (and (not (at ?who ?from)) (at ?who ?to) (increase (total-cost) (+ 1 (steps ?to)))))
  (:action fetch
    :parameters (?who - agent ?what - thing ?where - room)
    :precondition (and (at ?who ?where) (in ?what ?where))
    :effect (and (has ?who ?what) (not (in ?what ?where)) (increase (total-cost) 1)))
  (:action pass
    :parameters (?who ?whom - agent ?what - thing ?where - room)
    :precondition (and (at ?who ?where) (at ?whom ?where) (not (= ?who ?whom)) (has ?who ?what))
    :effect (and (has ?whom ?what) (not (has ?who ?what)) (increase (total-cost) 1)))
  (:action study
    :parameters (?who - agent ?what - thing)
    :precondition (and (has ?who ?what) (not (broken basement)))
    :effect (and (read ?what) (increase (total-cost) 0.25)))
  (:action wait
    :parameters (?who - agent)
    :effect (increase (total-cost) 0.01)))
