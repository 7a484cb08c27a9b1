; Anna waters the beds.  Names are in mixed case on purpose.
(define (domain Garden)
  (:requirements :typing :action-costs)
  (:types Bed Can - object)
  (:predicates
    (Path ?from ?to - Bed)
    (At-Anna ?b - Bed)
    (Anna-Holds ?c - Can)
    (Lies ?c - Can ?b - Bed)
    (Watered ?b - Bed))
  (:functions (total-cost) - number)
  (:action Walk
    :parameters (?from ?to - Bed)
    :precondition (and (At-Anna ?from) (Path ?from ?to))
    :effect (and (not (At-Anna ?from)) (At-Anna ?to) (increase (total-cost) 1)))
  (:action Take
    :parameters (?c - Can ?b - Bed)
    :precondition (and (At-Anna ?b) (Lies ?c ?b))
    :effect (and (Anna-Holds ?c) (not (Lies ?c ?b)) (increase (total-cost) 2)))
  (:action Water
    :parameters (?b - Bed ?c - Can)
    :precondition (and (At-Anna ?b) (Anna-Holds ?c))
    :effect (and (Watered ?b) (increase (total-cost) 0.5)))
  (:action Look
    :parameters ()
    :effect (increase (total-cost) 0.01)))
