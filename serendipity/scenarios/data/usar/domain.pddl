(define (domain usar)
  (:requirements :strips :typing :equality :negative-preconditions)
  (:types
    location thing - object
    agent medkit - thing
    person machine - agent)
  (:predicates
    (connected ?from ?to - location)
    (at ?what - thing ?where - location)
    (has ?who - agent ?kit - medkit)
    (has_medkit ?who - agent)
    (loc_has_medkit ?where - location)
    (delivered ?who - agent ?kit - medkit ?where - location)
    (conducted_triage ?who - person ?where - location))

  (:action move
    :parameters (?who - agent ?from ?to - location)
    :precondition (and (at ?who ?from) (connected ?from ?to))
    :effect (and (at ?who ?to) (not (at ?who ?from))))

  (:action move_reverse
    :parameters (?who - agent ?from ?to - location)
    :precondition (and (at ?who ?from) (connected ?to ?from))
    :effect (and (at ?who ?to) (not (at ?who ?from))))

  (:action pick_up_medkit
    :parameters (?who - agent ?kit - medkit ?where - location)
    :precondition (and (at ?who ?where) (at ?kit ?where))
    :effect (and (has_medkit ?who) (has ?who ?kit)
                 (not (at ?kit ?where)) (not (loc_has_medkit ?where))))

  (:action drop_off
    :parameters (?who - agent ?kit - medkit ?where - location)
    :precondition (and (at ?who ?where) (has ?who ?kit))
    :effect (and (delivered ?who ?kit ?where) (loc_has_medkit ?where) (at ?kit ?where)
                 (not (has ?who ?kit)) (not (has_medkit ?who))))

  (:action conduct_triage
    :parameters (?who - person ?where - location)
    :precondition (and (at ?who ?where) (has_medkit ?who))
    :effect (conducted_triage ?who ?where))

  (:action hand_over
    :parameters (?giver ?taker - agent ?kit - medkit ?where - location)
    :precondition (and (not (= ?giver ?taker)) (at ?giver ?where) (at ?taker ?where)
                       (has_medkit ?giver) (has ?giver ?kit))
    :effect (and (has_medkit ?taker) (has ?taker ?kit)
                 (not (has ?giver ?kit)) (not (has_medkit ?giver)))))
