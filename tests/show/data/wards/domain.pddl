; A nurse, two carts that can drive and lift, ten wards: sheets to change, a patient to lift, an aspirin to bring.
(define (domain wards)
  (:requirements :adl :action-costs)
  (:types agent place thing patient - object
          nurse cart - agent
          sheet drug - thing)
  (:predicates (at ?a - agent ?p - place) (door ?p ?q - place)
               (lies ?t - thing ?p - place) (carries ?a - agent ?t - thing) (full ?a - agent)
               (stocked ?d - drug) (given ?d - drug) (cabinet ?p - place)
               (used ?s - sheet) (fresh ?p - place) (wet ?p - place) (handwashed ?n - nurse)
               (in-bed ?x - patient ?p - place) (up ?x - patient) (treated ?x - patient))
  (:functions (total-cost) - number (weight ?x - patient) - number)
  (:action go
    :parameters (?a - agent ?p ?q - place)
    :precondition (and (at ?a ?p) (or (door ?p ?q) (door ?q ?p)))
    :effect (and (not (at ?a ?p)) (at ?a ?q) (increase (total-cost) 1)))
  (:action take
    :parameters (?a - agent ?t - thing ?p - place)
    :precondition (and (at ?a ?p) (lies ?t ?p) (not (full ?a)))
    :effect (and (not (lies ?t ?p)) (carries ?a ?t) (full ?a) (increase (total-cost) 1)))
  (:action fetch
    :parameters (?a - agent ?d - drug ?p - place)
    :precondition (and (at ?a ?p) (cabinet ?p) (stocked ?d) (not (full ?a)))
    :effect (and (not (stocked ?d)) (carries ?a ?d) (full ?a) (increase (total-cost) 1)))
  (:action hand
    :parameters (?a ?b - agent ?t - thing ?p - place)
    :precondition (and (not (= ?a ?b)) (at ?a ?p) (at ?b ?p) (carries ?a ?t) (not (full ?b)))
    :effect (and (not (carries ?a ?t)) (not (full ?a)) (carries ?b ?t) (full ?b) (increase (total-cost) 1)))
  (:action make-bed
    :parameters (?n - nurse ?s - sheet ?p - place)
    :precondition (and (at ?n ?p) (carries ?n ?s) (forall (?x - patient) (imply (in-bed ?x ?p) (up ?x))))
    :effect (and (not (carries ?n ?s)) (not (full ?n)) (used ?s) (fresh ?p)
                 (when (wet ?p) (not (wet ?p))) (increase (total-cost) 2)))
  (:action lift-alone
    :parameters (?n - nurse ?x - patient ?p - place)
    :precondition (and (at ?n ?p) (in-bed ?x ?p) (not (up ?x)) (not (full ?n)))
    :effect (and (up ?x) (increase (total-cost) (weight ?x))))
  (:action lift
    :parameters (?n - nurse ?c - cart ?x - patient ?p - place)
    :precondition (and (at ?n ?p) (at ?c ?p) (in-bed ?x ?p) (not (up ?x)))
    :effect (and (up ?x) (increase (total-cost) 2)))
  (:action treat
    :parameters (?n - nurse ?d - drug ?x - patient ?p - place)
    :precondition (and (at ?n ?p) (in-bed ?x ?p) (carries ?n ?d) (exists (?q - place) (fresh ?q)))
    :effect (and (treated ?x) (given ?d) (not (carries ?n ?d)) (not (full ?n)) (increase (total-cost) 1))))
