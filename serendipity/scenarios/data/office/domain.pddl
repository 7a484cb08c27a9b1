; Talks in an office of two floors, in minutes: rooms may be taken, and the lift carries one person at a time.
(define (domain office)
  (:requirements :strips :typing :multi-agent :durative-actions :timed-initial-literals)
  (:types person robot - agent place thing)
  (:predicates (at ?who - agent ?where - place) (way ?a ?b - place) (shaft ?a ?b - place)
               (lift-at ?a - place) (lies ?what - thing ?where - place) (has ?who - agent ?what - thing)
               (free ?where - place) (chairs-in ?where - place) (shown ?what - thing ?where - place))
  (:durative-action walk
    :agent ?who - agent
    :parameters (?from ?to - place)
    :duration (= ?duration 2)
    :condition (and (at start (at ?who ?from)) (at start (way ?from ?to)) (over all (free ?to)))
    :effect (and (at start (not (at ?who ?from))) (at end (at ?who ?to))))
  (:durative-action ride
    :agent ?who - person
    :parameters (?from ?to - place)
    :duration (= ?duration 4)
    :condition (and (at start (at ?who ?from)) (at start (lift-at ?from)) (at start (shaft ?from ?to)))
    :effect (and (at start (not (at ?who ?from))) (at start (not (lift-at ?from)))
                 (at end (at ?who ?to)) (at end (lift-at ?to))))
  (:durative-action call-lift
    :agent ?who - person
    :parameters (?to ?from - place)
    :duration (= ?duration 6)
    :condition (and (at start (lift-at ?from)) (at start (shaft ?from ?to)) (at start (at ?who ?to)))
    :effect (and (at start (not (lift-at ?from))) (at end (lift-at ?to))))
  (:durative-action take
    :agent ?who - agent
    :parameters (?what - thing ?where - place)
    :duration (= ?duration 2)
    :condition (and (at start (at ?who ?where)) (at start (lies ?what ?where)))
    :effect (and (at start (not (lies ?what ?where))) (at end (has ?who ?what))))
  (:durative-action set-chairs
    :agent ?who - agent
    :parameters (?where - place)
    :duration (= ?duration 8)
    :condition (and (at start (at ?who ?where)) (at start (free ?where)))
    :effect (at end (chairs-in ?where)))
  (:durative-action show
    :agent ?who - agent
    :parameters (?what - thing ?where - place)
    :duration (= ?duration 6)
    :condition (and (at start (at ?who ?where)) (at start (has ?who ?what)) (at start (chairs-in ?where)))
    :effect (at end (shown ?what ?where))))
