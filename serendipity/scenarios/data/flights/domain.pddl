; Aircraft carry passengers. Every flight takes one level of fuel; filling up takes longer than flying.
(define (domain flights)
  (:requirements :strips :typing :action-costs :multi-agent)
  (:types airport level thing - object
          passenger aircraft - thing)
  (:predicates (route ?a ?b - airport) (pump ?where - airport)
               (at ?what - thing ?where - airport) (aboard ?who - passenger ?plane - aircraft)
               (fuel ?plane - aircraft ?left - level) (next ?above ?below - level) (full ?left - level))
  (:functions (total-cost) - number)
  (:action fly
    :agent ?plane - aircraft
    :parameters (?from ?to - airport ?before ?after - level)
    :precondition (and (at ?plane ?from) (route ?from ?to) (fuel ?plane ?before) (next ?before ?after))
    :effect (and (at ?plane ?to) (fuel ?plane ?after) (not (at ?plane ?from)) (not (fuel ?plane ?before))
                 (increase (total-cost) 3)))
  (:action refuel
    :agent ?plane - aircraft
    :parameters (?where - airport ?before ?after - level)
    :precondition (and (at ?plane ?where) (pump ?where) (fuel ?plane ?before) (full ?after))
    :effect (and (fuel ?plane ?after) (not (fuel ?plane ?before)) (increase (total-cost) 4)))
  (:action board
    :agent ?plane - aircraft
    :parameters (?who - passenger ?where - airport)
    :precondition (and (at ?plane ?where) (at ?who ?where))
    :effect (and (aboard ?who ?plane) (not (at ?who ?where)) (increase (total-cost) 1)))
  (:action alight
    :agent ?plane - aircraft
    :parameters (?who - passenger ?where - airport)
    :precondition (and (at ?plane ?where) (aboard ?who ?plane))
    :effect (and (at ?who ?where) (not (aboard ?who ?plane)) (increase (total-cost) 1))))
