; A morning at home, in minutes: people sleep until the alarm, and wash once the water is hot.
(define (domain morning)
  (:requirements :strips :typing :multi-agent :durative-actions :timed-initial-literals)
  (:types agent room)
  (:constants bedroom bath kitchen - room)
  (:predicates (at ?who - agent ?where - room) (door ?a ?b - room) (awake ?who - agent)
               (hot-water) (dressed ?who - agent) (clean ?who - agent) (fed ?who - agent)
               (coffee) (table-laid))
  (:durative-action walk
    :agent ?who - agent
    :parameters (?from ?to - room)
    :duration (= ?duration 2)
    :condition (and (at start (at ?who ?from)) (at start (door ?from ?to)) (at start (awake ?who)))
    :effect (and (at start (not (at ?who ?from))) (at end (at ?who ?to))))
  (:durative-action dress
    :agent ?who - agent
    :parameters ()
    :duration (= ?duration 4)
    :condition (and (at start (at ?who bedroom)) (at start (awake ?who)))
    :effect (at end (dressed ?who)))
  (:durative-action wash
    :agent ?who - agent
    :parameters ()
    :duration (= ?duration 6)
    :condition (and (at start (at ?who bath)) (at start (dressed ?who)) (at start (hot-water)))
    :effect (at end (clean ?who)))
  (:durative-action make-coffee
    :agent ?who - agent
    :parameters ()
    :duration (= ?duration 8)
    :condition (at start (at ?who kitchen))
    :effect (at end (coffee)))
  (:durative-action lay-table
    :agent ?who - agent
    :parameters ()
    :duration (= ?duration 4)
    :condition (at start (at ?who kitchen))
    :effect (at end (table-laid)))
  (:durative-action breakfast
    :agent ?who - agent
    :parameters ()
    :duration (= ?duration 10)
    :condition (and (at start (at ?who kitchen)) (at start (clean ?who)) (at start (coffee))
                    (at start (table-laid)))
    :effect (and (at end (fed ?who)) (at end (not (coffee))))))
